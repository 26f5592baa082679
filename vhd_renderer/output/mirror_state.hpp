// What the mirror's page knows besides the picture, as the JSON it is sent as.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "vhd_renderer/output/web_mirror.hpp"

namespace counterpart {

class MirrorState {
 public:
  void set(const BoardState& board);
  void add(const GameEvent& event);
  void set(const Feedback& feedback);
  void set_subtitle(const std::string& text);
  void set_speech(std::uint64_t number);  // of what is being heard; 0: nothing
  void set(const MirrorStatus& status);
  void set_picture_size(int width, int height);

  // Grows with every change.
  std::uint64_t version() const { return version_; }
  std::string json() const;

 private:
  std::uint64_t version_ = 1;
  std::optional<BoardState> board_;
  std::deque<GameEvent> events_;  // the newest, oldest first
  std::optional<Feedback> feedback_;
  std::string subtitle_;
  std::uint64_t speech_ = 0;
  MirrorStatus status_;
  int width_ = 0, height_ = 0;  // pixels
};

// A Control as docs/protocol.md writes it; without an id it gets 0.
[[nodiscard]] Result<Control> read_control(const std::string& text);

}  // namespace counterpart
