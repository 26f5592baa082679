// Reads the messages of an MCAP file in the order they were written. A damaged or cut-off file gives what stands before
// the damage, and says what is wrong.
#pragma once

#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "protocol/codec/bytes.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct CaptureMessage {
  std::string topic;
  std::string encoding;
  std::uint64_t log_ns = 0;
  std::uint64_t publish_ns = 0;
  Bytes data;
};

class McapReader {
 public:
  [[nodiscard]] static Result<std::unique_ptr<McapReader>> open(const std::string& path);
  virtual ~McapReader() = default;

  // Empty: there are no more.
  std::optional<CaptureMessage> next();

  // What is wrong with the file, as far as it was read; empty: nothing.
  const std::optional<Error>& problem() const { return problem_; }
  // True once the closing magic was reached: the writer finished it.
  bool complete() const { return complete_; }
  std::uint64_t chunks() const { return chunks_; }
  const std::map<std::string, std::map<std::string, std::string>>& metadata() const { return metadata_; }

 private:
  struct Channel {
    std::string topic, encoding;
  };

  McapReader() = default;
  bool read_record();
  void open_chunk(ByteView content, bool whole);
  std::optional<CaptureMessage> message_in(ByteView content);
  void read_channel(ByteView content);
  void read_metadata(ByteView content);
  void trouble(const std::string& what);

  std::ifstream in_;
  std::string path_;
  std::uint64_t size_ = 0;      // of the file
  std::uint64_t position_ = 0;  // of the next record
  bool ended_ = false;
  bool complete_ = false;
  std::uint64_t chunks_ = 0;
  std::optional<Error> problem_;
  Bytes records_;  // of the open chunk
  std::size_t at_ = 0;
  std::optional<CaptureMessage> loose_;  // a message outside any chunk
  std::map<std::uint16_t, Channel> channels_;
  std::map<std::string, std::map<std::string, std::string>> metadata_;
};

}  // namespace counterpart
