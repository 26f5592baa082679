#include "protocol/capture/mcap_reader.hpp"

#include <algorithm>
#include <cstring>

#include "protocol/capture/mcap.hpp"

namespace counterpart {

using namespace mcap;

namespace {

constexpr std::uint64_t kMostChunk = 256U << 20;  // ours are about 1 MiB, or one picture

// Takes fields off the front of a record; after the first that does not fit, `good` stays false.
class Cursor {
 public:
  explicit Cursor(ByteView bytes) : bytes_(bytes) {}

  template <class T>
  T number() {
    if (bytes_.size() < sizeof(T)) good_ = false;
    if (!good_) return {};
    const T value = load<T>(bytes_.data());
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }

  ByteView take(std::uint64_t size) {
    if (bytes_.size() < size) good_ = false;
    if (!good_) return {};
    const ByteView taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }

  std::string text() {
    const ByteView taken = take(number<std::uint32_t>());
    return {taken.begin(), taken.end()};
  }

  ByteView rest() const { return bytes_; }
  bool good() const { return good_; }

 private:
  ByteView bytes_;
  bool good_ = true;
};

}  // namespace

Result<std::unique_ptr<McapReader>> McapReader::open(const std::string& path) {
  std::unique_ptr<McapReader> reader(new McapReader);
  reader->path_ = path;
  reader->in_.open(path, std::ios::binary);
  if (!reader->in_) return failure(ErrorCode::not_found, "the capture " + path + " cannot be opened");
  reader->in_.seekg(0, std::ios::end);
  const auto size = reader->in_.tellg();
  reader->in_.seekg(0);
  std::array<char, 8> magic{};
  reader->in_.read(magic.data(), magic.size());
  if (!reader->in_ || size < 8 || std::memcmp(magic.data(), kMagic.data(), kMagic.size()) != 0) {
    return failure(ErrorCode::bad_format, path + " is not an MCAP capture");
  }
  reader->size_ = static_cast<std::uint64_t>(size);
  reader->position_ = kMagic.size();
  return reader;
}

void McapReader::trouble(const std::string& what) {
  if (!problem_) problem_ = Error{ErrorCode::bad_format, path_ + ": " + what};
}

std::optional<CaptureMessage> McapReader::next() {
  while (true) {
    if (loose_) return std::exchange(loose_, std::nullopt);
    if (records_.size() - at_ < kRecordHead) {
      if (ended_ || !read_record()) return std::nullopt;
      continue;
    }
    const auto op = static_cast<Op>(records_[at_]);
    const auto length = load<std::uint64_t>(records_.data() + at_ + 1);
    if (length > records_.size() - at_ - kRecordHead) {
      at_ = records_.size();  // the end of a chunk that was cut off
      continue;
    }
    const ByteView content = ByteView(records_).subspan(at_ + kRecordHead, length);
    at_ += kRecordHead + length;
    if (op == Op::channel) read_channel(content);
    if (op != Op::message) continue;
    if (auto message = message_in(content)) return message;
  }
}

// One record of the file's top level. False: the end, or nothing more can be read.
bool McapReader::read_record() {
  const std::uint64_t left = size_ - position_;
  std::array<std::uint8_t, kRecordHead> head{};
  in_.read(reinterpret_cast<char*>(head.data()), head.size());
  if (!in_) {
    trouble("the file ends without a footer: its writer was interrupted");
    ended_ = true;
    return false;
  }
  const auto op = static_cast<Op>(head[0]);
  const auto length = load<std::uint64_t>(head.data() + 1);
  const bool whole = length <= left - kRecordHead;
  if (length > kMostChunk || (!whole && op != Op::chunk)) {
    trouble(whole ? "a record is larger than any that is written" : "the file is cut off inside a record");
    ended_ = true;
    return false;
  }
  Bytes content(whole ? length : left - kRecordHead);
  in_.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(content.size()));
  if (!in_) {
    trouble("the file cannot be read to its end");
    ended_ = true;
    return false;
  }
  position_ += kRecordHead + content.size();
  if (!whole) {
    trouble("the file is cut off inside a chunk");
    ended_ = true;
  }
  switch (op) {
    case Op::chunk:
      open_chunk(content, whole);
      break;
    case Op::channel:
      read_channel(content);
      break;
    case Op::message:
      loose_ = message_in(content);
      break;
    case Op::metadata:
      read_metadata(content);
      break;
    case Op::footer: {
      std::array<std::uint8_t, 8> magic{};
      in_.read(reinterpret_cast<char*>(magic.data()), magic.size());
      complete_ = in_ && magic == kMagic;
      if (!complete_) trouble("the closing magic is missing");
      ended_ = true;
      break;
    }
    default:
      break;
  }
  return true;
}

void McapReader::open_chunk(ByteView content, bool whole) {
  Cursor cursor(content);
  cursor.take(16);
  const auto size = cursor.number<std::uint64_t>();
  const auto crc = cursor.number<std::uint32_t>();
  const std::string compression = cursor.text();
  const auto records_size = cursor.number<std::uint64_t>();
  if (!cursor.good()) return trouble("a chunk is too short");
  if (!compression.empty()) {
    return trouble("a chunk is compressed with " + compression.substr(0, 16) + ", which this program does not read");
  }
  const ByteView records = cursor.rest().first(std::min<std::uint64_t>(cursor.rest().size(), records_size));
  if (whole && (records.size() != records_size || records_size != size || (crc != 0 && mcap::crc32(records) != crc))) {
    return trouble("the checksum of chunk " + std::to_string(chunks_ + 1) + " does not match: it is passed over");
  }
  if (whole) ++chunks_;
  records_.assign(records.begin(), records.end());
  at_ = 0;
}

std::optional<CaptureMessage> McapReader::message_in(ByteView content) {
  Cursor cursor(content);
  const auto channel = channels_.find(cursor.number<std::uint16_t>());
  cursor.number<std::uint32_t>();
  CaptureMessage message;
  message.log_ns = cursor.number<std::uint64_t>();
  message.publish_ns = cursor.number<std::uint64_t>();
  if (!cursor.good() || channel == channels_.end()) {
    trouble("a message is too short or names no channel");
    return std::nullopt;
  }
  message.topic = channel->second.topic;
  message.encoding = channel->second.encoding;
  message.data.assign(cursor.rest().begin(), cursor.rest().end());
  return message;
}

void McapReader::read_channel(ByteView content) {
  Cursor cursor(content);
  const auto id = cursor.number<std::uint16_t>();
  cursor.number<std::uint16_t>();
  Channel channel;
  channel.topic = cursor.text();
  channel.encoding = cursor.text();
  if (!cursor.good()) return trouble("a channel record is too short");
  channels_[id] = channel;
}

void McapReader::read_metadata(ByteView content) {
  Cursor cursor(content);
  const std::string name = cursor.text();
  Cursor entries(cursor.take(cursor.number<std::uint32_t>()));
  std::map<std::string, std::string> values;
  while (entries.good() && !entries.rest().empty()) {
    const std::string key = entries.text();
    const std::string value = entries.text();
    if (entries.good()) values[key] = value;
  }
  if (!cursor.good() || !entries.good()) return trouble("a metadata record is too short");
  metadata_[name] = values;
}

}  // namespace counterpart
