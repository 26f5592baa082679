#include "vhd_renderer/output/mirror_state.hpp"

#include <nlohmann/json.hpp>

#include "protocol/codec/json.hpp"

namespace counterpart {
namespace {

constexpr std::size_t kMostEvents = 40;

}  // namespace

void MirrorState::set(const BoardState& board) {
  board_ = board;
  ++version_;
}

void MirrorState::add(const GameEvent& event) {
  events_.push_back(event);
  if (events_.size() > kMostEvents) events_.pop_front();
  ++version_;
}

void MirrorState::set(const Feedback& feedback) {
  feedback_ = feedback;
  ++version_;
}

void MirrorState::set_subtitle(const std::string& text) {
  if (text == subtitle_) return;
  subtitle_ = text;
  ++version_;
}

void MirrorState::set_speech(std::uint64_t number) {
  speech_ = number;
  ++version_;
}

void MirrorState::set(const MirrorStatus& status) {
  status_ = status;
  ++version_;
}

void MirrorState::set_picture_size(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  ++version_;
}

std::string MirrorState::json() const {
  nlohmann::json out{{"version", version_},
                     {"board", nullptr},
                     {"feedback", nullptr},
                     {"subtitle", subtitle_},
                     {"speech", speech_},
                     {"picture", {{"width", width_}, {"height", height_}}},
                     {"status",
                      {{"fps", status_.fps},
                       {"frames", status_.frames},
                       {"dropped", status_.dropped},
                       {"tracker_connected", status_.tracker_connected},
                       {"tracking", status_.tracking},
                       {"round_trip_ms", status_.round_trip_ms}}}};
  if (board_) out["board"] = to_json(*board_);
  if (feedback_) out["feedback"] = to_json(*feedback_);
  out["events"] = nlohmann::json::array();
  for (const GameEvent& event : events_) out["events"].push_back(to_json(event));
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<Control> read_control(const std::string& text) {
  auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return failure(ErrorCode::bad_format, "a control is a JSON object");
  if (!json.contains("id")) json["id"] = 0;
  return from_json<Control>(json);
}

}  // namespace counterpart
