#include "protocol/capture/mcap_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

#include "protocol/capture/mcap.hpp"

namespace counterpart {

using namespace mcap;

Result<std::unique_ptr<McapWriter>> McapWriter::create(const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) {
    return failure(ErrorCode::io, "the capture " + path + " cannot be created: " + std::strerror(errno));
  }
  std::unique_ptr<McapWriter> writer(new McapWriter(file, path));
  Bytes start(kMagic.begin(), kMagic.end());
  Bytes header;
  append_text(header, "counterpart");
  append_text(header, "counterpart " COUNTERPART_VERSION);
  append_record(start, Op::header, header);
  if (auto done = writer->put(start); !done) return tl::make_unexpected(done.error());
  return writer;
}

McapWriter::~McapWriter() {
  if (!closed_) static_cast<void>(close());  // a caller who wants to know calls close() itself
}

Result<void> McapWriter::put(ByteView bytes) {
  if (file_ < 0) return failure(ErrorCode::closed, "the capture " + path_ + " is closed");
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::write(file_, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      // A half-written record at the end would only confuse readers; what stands before it is whole.
      const int why = errno;
      const bool cut = ::ftruncate(file_, static_cast<off_t>(written_)) == 0;
      return failure(ErrorCode::io, "the capture " + path_ + " cannot be written: " + std::strerror(why) +
                                        (cut ? "; what was recorded before is kept" : ""));
    }
    done += static_cast<std::size_t>(count);
  }
  written_ += bytes.size();
  return {};
}

std::uint16_t McapWriter::channel(const std::string& topic, const std::string& encoding) {
  const auto [entry, added] = topics_.try_emplace(topic, static_cast<std::uint16_t>(topics_.size() + 1));
  if (added) {
    Channel& channel = channels_[entry->second];
    channel.topic = topic;
    channel.encoding = encoding;
  }
  return entry->second;
}

void McapWriter::add(std::uint16_t id, std::uint64_t log_ns, std::uint64_t publish_ns, ByteView data) {
  Channel& channel = channels_.at(id);
  // Each chunk names its own channels, so that it can be read without the others.
  if (channel.index.empty()) append_record(records_, Op::channel, channel_record(id));
  const bool first_of_chunk = chunk_first_ns_ == 0 && chunk_last_ns_ == 0;
  chunk_first_ns_ = first_of_chunk ? log_ns : std::min(chunk_first_ns_, log_ns);
  chunk_last_ns_ = std::max(chunk_last_ns_, log_ns);
  first_ns_ = messages_ == 0 ? log_ns : std::min(first_ns_, log_ns);
  last_ns_ = std::max(last_ns_, log_ns);
  channel.index.emplace_back(log_ns, records_.size());
  append(records_, static_cast<std::uint8_t>(Op::message));
  append(records_, static_cast<std::uint64_t>(22 + data.size()));
  append(records_, id);
  append(records_, channel.next_sequence++);
  append(records_, log_ns);
  append(records_, publish_ns);
  records_.insert(records_.end(), data.begin(), data.end());
  ++channel.messages;
  ++messages_;
}

Result<void> McapWriter::write_chunk() {
  if (records_.empty()) return {};
  ChunkEntry entry;
  entry.first_ns = chunk_first_ns_;
  entry.last_ns = chunk_last_ns_;
  entry.at = written_;
  entry.size = records_.size();
  Bytes out;
  out.reserve(records_.size() + 4096);
  append(out, static_cast<std::uint8_t>(Op::chunk));
  append(out, static_cast<std::uint64_t>(8 + 8 + 8 + 4 + 4 + 8 + records_.size()));
  append(out, entry.first_ns);
  append(out, entry.last_ns);
  append(out, static_cast<std::uint64_t>(records_.size()));
  append(out, crc32(records_));
  append_text(out, "");  // no compression
  append(out, static_cast<std::uint64_t>(records_.size()));
  out.insert(out.end(), records_.begin(), records_.end());
  entry.length = out.size();
  for (auto& [id, channel] : channels_) {
    if (channel.index.empty()) continue;
    Bytes index;
    append(index, id);
    append(index, static_cast<std::uint32_t>(16 * channel.index.size()));
    for (const auto& [log_ns, at] : channel.index) {
      append(index, log_ns);
      append(index, at);
    }
    entry.index_at[id] = written_ + out.size();
    append_record(out, Op::message_index, index);
    channel.index.clear();
  }
  entry.index_length = out.size() - entry.length;
  records_.clear();
  chunk_first_ns_ = chunk_last_ns_ = 0;
  if (auto done = put(out); !done) return done;
  chunks_.push_back(std::move(entry));
  return {};
}

Result<void> McapWriter::write_metadata(const std::string& name, const std::map<std::string, std::string>& values) {
  Bytes content, out;
  append_text(content, name);
  append_map(content, values);
  append_record(out, Op::metadata, content);
  const MetadataEntry entry{written_, out.size(), name};
  if (auto done = put(out); !done) return done;
  metadata_.push_back(entry);
  return {};
}

Result<void> McapWriter::close() {
  if (closed_) return {};
  closed_ = true;
  auto done = write_chunk();
  if (done) {
    Bytes end;
    Bytes data_end;
    append(data_end, std::uint32_t{0});  // the checksum of the data section is optional; the chunks have theirs
    append_record(end, Op::data_end, data_end);
    const Bytes rest = summary(written_ + end.size());
    end.insert(end.end(), rest.begin(), rest.end());
    done = put(end);
  }
  if (::close(file_) != 0 && done) {
    done = failure(ErrorCode::io, "the capture " + path_ + " cannot be closed: " + std::strerror(errno));
  }
  file_ = -1;
  return done;
}

Bytes McapWriter::channel_record(std::uint16_t id) const {
  const Channel& channel = channels_.at(id);
  Bytes out;
  append(out, id);
  append(out, std::uint16_t{0});  // no schema: docs/protocol.md describes the bodies
  append_text(out, channel.topic);
  append_text(out, channel.encoding);
  append_map(out, {});
  return out;
}

Bytes McapWriter::statistics_record() const {
  Bytes counts;
  std::uint32_t channels = 0;
  for (const auto& [id, channel] : channels_) {
    append(counts, id);
    append(counts, channel.messages);
    ++channels;
  }
  Bytes out;
  append(out, messages_);
  append(out, std::uint16_t{0});
  append(out, channels);
  append(out, std::uint32_t{0});
  append(out, static_cast<std::uint32_t>(metadata_.size()));
  append(out, static_cast<std::uint32_t>(chunks_.size()));
  append(out, first_ns_);
  append(out, last_ns_);
  append(out, static_cast<std::uint32_t>(counts.size()));
  out.insert(out.end(), counts.begin(), counts.end());
  return out;
}

Bytes McapWriter::chunk_index_record(const ChunkEntry& chunk) const {
  Bytes out;
  append(out, chunk.first_ns);
  append(out, chunk.last_ns);
  append(out, chunk.at);
  append(out, chunk.length);
  append(out, static_cast<std::uint32_t>(10 * chunk.index_at.size()));
  for (const auto& [id, at] : chunk.index_at) {
    append(out, id);
    append(out, at);
  }
  append(out, chunk.index_length);
  append_text(out, "");
  append(out, chunk.size);
  append(out, chunk.size);
  return out;
}

// Summary, summary offsets, footer and the closing magic.
Bytes McapWriter::summary(std::uint64_t start) const {
  Bytes out, offsets;
  const auto group = [&](Op op, std::size_t from) {
    if (out.size() == from) return;
    Bytes content;
    append(content, static_cast<std::uint8_t>(op));
    append(content, start + from);
    append(content, static_cast<std::uint64_t>(out.size() - from));
    append_record(offsets, Op::summary_offset, content);
  };
  std::size_t from = out.size();
  for (const auto& [id, channel] : channels_) append_record(out, Op::channel, channel_record(id));
  group(Op::channel, from);
  from = out.size();
  append_record(out, Op::statistics, statistics_record());
  group(Op::statistics, from);
  from = out.size();
  for (const ChunkEntry& chunk : chunks_) append_record(out, Op::chunk_index, chunk_index_record(chunk));
  group(Op::chunk_index, from);
  from = out.size();
  for (const MetadataEntry& entry : metadata_) {
    Bytes content;
    append(content, entry.at);
    append(content, entry.length);
    append_text(content, entry.name);
    append_record(out, Op::metadata_index, content);
  }
  group(Op::metadata_index, from);
  const std::uint64_t offsets_at = start + out.size();
  out.insert(out.end(), offsets.begin(), offsets.end());
  append(out, static_cast<std::uint8_t>(Op::footer));
  append(out, std::uint64_t{20});
  append(out, start);
  append(out, offsets_at);
  append(out, crc32(out));  // of everything from the summary's start up to this field
  out.insert(out.end(), kMagic.begin(), kMagic.end());
  return out;
}

}  // namespace counterpart
