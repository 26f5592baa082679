#include "protocol/framing/frame_parser.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace counterpart {

std::span<std::uint8_t> FrameParser::room() {
  if (open_ && begin_ == end_) {
    grow_body(body_have_ + kStep);
    return std::span(open_->body).subspan(body_have_);
  }
  if (begin_ == end_) begin_ = end_ = 0;
  if (end_ == buffer_.size()) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  return std::span(buffer_).subspan(end_);
}

void FrameParser::grow_body(std::size_t size) {
  Bytes& body = open_->body;
  size = std::min<std::size_t>(size, open_->header.length);
  if (size <= body.size()) return;
  if (size > body.capacity()) body.reserve(open_->header.length);
  body.resize(size);
}

void FrameParser::filled(std::size_t count) {
  if (open_ && begin_ == end_) {
    body_have_ += count;
  } else {
    end_ += count;
  }
}

Result<std::optional<RawMessage>> FrameParser::next() {
  if (failed_) return tl::make_unexpected(*failed_);
  if (!open_) {
    if (end_ - begin_ < kHeaderSize) return std::nullopt;
    RawMessage message;
    std::memcpy(message.header_bytes.data(), buffer_.data() + begin_, kHeaderSize);
    auto header = read_header(message.header_bytes);
    if (!header) {
      failed_ = header.error();
      return tl::make_unexpected(*failed_);
    }
    begin_ += kHeaderSize;
    message.header = *header;
    message.body = std::exchange(spare_, {});
    open_ = std::move(message);
    body_have_ = 0;
  }
  const std::size_t take = std::min(open_->header.length - body_have_, end_ - begin_);
  if (take > 0) grow_body(body_have_ + take);
  if (take > 0) std::memcpy(open_->body.data() + body_have_, buffer_.data() + begin_, take);
  begin_ += take;
  body_have_ += take;
  if (body_have_ < open_->header.length) return std::nullopt;
  if (!crc_matches(open_->header_bytes, open_->body)) {
    failed_ = Error{ErrorCode::bad_format, "the checksum of a message of type " + std::to_string(open_->header.type) +
                                               " does not match: its bytes were changed on the way"};
    return tl::make_unexpected(*failed_);
  }
  std::optional<RawMessage> whole = std::move(open_);
  open_.reset();
  return whole;
}

void FrameParser::reuse(Bytes&& body) {
  if (body.capacity() > kBufferSize) return;  // large ones are rare, and would only be held
  spare_ = std::move(body);
  spare_.clear();
}

std::size_t FrameParser::feed(ByteView bytes) {
  const auto space = room();
  const std::size_t count = std::min(space.size(), bytes.size());
  if (count > 0) std::memcpy(space.data(), bytes.data(), count);
  filled(count);
  return count;
}

bool FrameParser::inside_message() const {
  return open_.has_value() || end_ > begin_;
}

}  // namespace counterpart
