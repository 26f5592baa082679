// Writes one MCAP file, chunk by chunk. Every whole chunk on the disk can be read, whatever happens afterwards.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "protocol/codec/bytes.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

class McapWriter {
 public:
  // Replaces a file of that name.
  [[nodiscard]] static Result<std::unique_ptr<McapWriter>> create(const std::string& path);
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // The number of the channel of this topic; a topic has one encoding.
  std::uint16_t channel(const std::string& topic, const std::string& encoding);

  // Into the chunk in the making. sequence counts by channel.
  void add(std::uint16_t channel, std::uint64_t log_ns, std::uint64_t publish_ns, ByteView data);
  std::size_t chunk_bytes() const { return records_.size(); }

  // Puts the chunk into the file. Fails if the disk is full or gone; what was written before stays readable.
  [[nodiscard]] Result<void> write_chunk();

  [[nodiscard]] Result<void> write_metadata(const std::string& name, const std::map<std::string, std::string>& values);

  // Writes what is left, the summary and the footer.
  [[nodiscard]] Result<void> close();

 private:
  struct Channel {
    std::string topic, encoding;
    std::uint32_t next_sequence = 0;
    std::uint64_t messages = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  // of the chunk in the making: log time, offset
  };
  struct ChunkEntry {
    std::uint64_t first_ns = 0, last_ns = 0, at = 0, length = 0, index_length = 0, size = 0;
    std::map<std::uint16_t, std::uint64_t> index_at;
  };
  struct MetadataEntry {
    std::uint64_t at = 0, length = 0;
    std::string name;
  };

  McapWriter(int file, std::string path) : file_(file), path_(std::move(path)) {}
  [[nodiscard]] Result<void> put(ByteView bytes);
  Bytes channel_record(std::uint16_t id) const;
  Bytes statistics_record() const;
  Bytes chunk_index_record(const ChunkEntry& chunk) const;
  Bytes summary(std::uint64_t start) const;

  int file_ = -1;
  std::string path_;
  std::uint64_t written_ = 0;  // bytes in the file
  bool closed_ = false;
  std::map<std::string, std::uint16_t> topics_;
  std::map<std::uint16_t, Channel> channels_;
  Bytes records_;  // of the chunk in the making
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::uint64_t first_ns_ = 0, last_ns_ = 0, messages_ = 0;
  std::vector<ChunkEntry> chunks_;
  std::vector<MetadataEntry> metadata_;
};

}  // namespace counterpart
