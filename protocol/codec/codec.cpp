#include "protocol/codec/codec.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "protocol/codec/json.hpp"
#include "protocol/codec/names.hpp"

namespace counterpart {
namespace {

constexpr std::size_t kPoseSize = 180;
constexpr std::size_t kVideoHead = 32;
constexpr std::size_t kMaskHead = 24;

template <class T>
constexpr bool is_fixed =
    std::is_same_v<T, Heartbeat> || std::is_same_v<T, ClockRequest> || std::is_same_v<T, ClockResponse> ||
    std::is_same_v<T, Acknowledge> || std::is_same_v<T, PoseEstimate> || std::is_same_v<T, VideoFrame> ||
    std::is_same_v<T, Mask> || std::is_same_v<T, FrameDone>;

tl::unexpected<Error> bad(MessageType type, const char* problem) {
  return failure(ErrorCode::bad_format, "a " + std::string(name_of(type)) + " message " + problem);
}

bool is_sane(const PoseEstimate& m) {
  double norm = 0;  // of the quaternion, squared; its length is within 0.001 of 1
  for (const double q : m.X_CB.q) norm += q * q;
  bool sane = norm > 0.999 * 0.999 && norm < 1.001 * 1.001;
  for (const double p : m.X_CB.p) sane &= std::abs(p) <= 1e6;
  for (const float c : m.covariance) sane &= std::isfinite(c);
  sane = sane && m.rms_px >= 0 && std::isfinite(m.rms_px) && m.seen_share >= 0 && m.seen_share <= 1;
  return sane && !name_of(m.status).empty();
}

bool is_sane(PixelCodec codec, std::uint32_t width, std::uint32_t height, std::uint32_t stride, std::size_t size) {
  if (width == 0 || height == 0 || width * height > kMostPixels) return false;
  if (codec == PixelCodec::jpeg) return stride == 0 && size > 0;
  if (codec == PixelCodec::h264) return size > 0;
  return codec == PixelCodec::raw_bgr8 && stride >= 3 * width && size == std::size_t{stride} * height;
}

bool is_sane(const Mask& m) {
  const auto covered = std::accumulate(m.runs.begin(), m.runs.end(), std::uint64_t{0});
  return m.width > 0 && m.height > 0 && covered == std::uint64_t{m.width} * m.height;
}

void put(Bytes& out, const FrameStamp& stamp) {
  append(out, stamp.frame_id);
  append(out, stamp.capture_ns);
}

void put(Bytes& out, const Heartbeat& m) {
  append(out, m.queued);
  append(out, std::uint32_t{0});
  append(out, m.dropped);
}

void put(Bytes& out, const ClockRequest& m) {
  append(out, m.sent_ns);
}

void put(Bytes& out, const ClockResponse& m) {
  append(out, m.sent_ns);
  append(out, m.received_ns);
  append(out, m.answered_ns);
}

void put(Bytes& out, const Acknowledge& m) {
  append(out, m.seq);
}

void put(Bytes& out, const FrameDone& m) {
  put(out, m.stamp);
}

// The most frequent message: its places are known, so nothing has to grow.
void put(Bytes& out, const PoseEstimate& m) {
  out.resize(kPoseSize);
  std::uint8_t* const body = out.data();
  store(body, m.stamp.frame_id);
  store(body + 8, m.stamp.capture_ns);
  store(body + 16, m.object_id);
  store(body + 20, m.intrinsics_id);
  store(body + 24, static_cast<std::uint32_t>(m.status));
  store(body + 28, m.rms_px);
  store(body + 32, m.seen_share);
  store(body + 36, std::uint32_t{0});
  for (std::size_t i = 0; i < 4; ++i) store(body + 40 + 8 * i, m.X_CB.q[i]);
  for (std::size_t i = 0; i < 3; ++i) store(body + 72 + 8 * i, m.X_CB.p[i]);
  for (std::size_t i = 0; i < m.covariance.size(); ++i) store(body + 96 + 4 * i, m.covariance[i]);
}

void put(Bytes& out, const VideoFrame& m) {
  out.reserve(kVideoHead + m.bytes.size());
  put(out, m.stamp);
  append(out, static_cast<std::uint16_t>(m.codec));
  append(out, m.width);
  append(out, m.height);
  append(out, std::uint16_t{0});
  append(out, m.stride);
  append(out, static_cast<std::uint32_t>(m.bytes.size()));
  out.insert(out.end(), m.bytes.begin(), m.bytes.end());
}

void put(Bytes& out, const Mask& m) {
  out.reserve(kMaskHead + 4 * m.runs.size());
  put(out, m.stamp);
  append(out, m.width);
  append(out, m.height);
  append(out, static_cast<std::uint32_t>(m.runs.size()));
  for (const std::uint32_t run : m.runs) append(out, run);
}

FrameStamp stamp_at(const std::uint8_t* at) {
  return {load<std::uint64_t>(at), load<std::int64_t>(at + 8)};
}

Result<Message> read_pose(ByteView body) {
  const std::uint8_t* at = body.data();
  PoseEstimate m;
  m.stamp = stamp_at(at);
  m.object_id = load<std::uint32_t>(at + 16);
  m.intrinsics_id = load<std::uint32_t>(at + 20);
  m.status = static_cast<TrackStatus>(load<std::uint8_t>(at + 24));
  m.rms_px = load<float>(at + 28);
  m.seen_share = load<float>(at + 32);
  for (std::size_t i = 0; i < 4; ++i) m.X_CB.q[i] = load<double>(at + 40 + 8 * i);
  for (std::size_t i = 0; i < 3; ++i) m.X_CB.p[i] = load<double>(at + 72 + 8 * i);
  for (std::size_t i = 0; i < m.covariance.size(); ++i) m.covariance[i] = load<float>(at + 96 + 4 * i);
  if (!is_sane(m)) return bad(MessageType::pose, "has numbers out of range");
  return m;
}

// Everything but the bytes of the picture.
Result<VideoFrame> read_video_head(ByteView body) {
  if (body.size() < kVideoHead) return bad(MessageType::video, "is too short");
  const std::uint8_t* at = body.data();
  VideoFrame m;
  m.stamp = stamp_at(at);
  m.codec = static_cast<PixelCodec>(load<std::uint16_t>(at + 16));
  m.width = load<std::uint16_t>(at + 18);
  m.height = load<std::uint16_t>(at + 20);
  m.stride = load<std::uint32_t>(at + 24);
  const auto size = load<std::uint32_t>(at + 28);
  if (size > body.size() - kVideoHead) return bad(MessageType::video, "is shorter than its picture");
  if (!is_sane(m.codec, m.width, m.height, m.stride, size)) {
    return bad(MessageType::video, "has a size that does not fit its codec");
  }
  return m;
}

std::size_t picture_size(ByteView body) {
  return load<std::uint32_t>(body.data() + 28);
}

Result<Message> read_video(ByteView body) {
  auto m = read_video_head(body);
  if (!m) return tl::make_unexpected(m.error());
  const ByteView picture = body.subspan(kVideoHead, picture_size(body));
  m->bytes.assign(picture.begin(), picture.end());
  return std::move(*m);
}

Result<Message> take_video(Bytes&& body) {
  auto m = read_video_head(body);
  if (!m) return tl::make_unexpected(m.error());
  const std::size_t size = picture_size(body);
  m->bytes = std::move(body);
  m->bytes.erase(m->bytes.begin(), m->bytes.begin() + static_cast<std::ptrdiff_t>(kVideoHead));
  m->bytes.resize(size);
  return std::move(*m);
}

Result<Message> read_mask(ByteView body) {
  const std::uint8_t* at = body.data();
  Mask m;
  m.stamp = stamp_at(at);
  m.width = load<std::uint16_t>(at + 16);
  m.height = load<std::uint16_t>(at + 18);
  const auto count = load<std::uint32_t>(at + 20);
  if (count > (body.size() - kMaskHead) / 4) return bad(MessageType::mask, "is shorter than its runs");
  m.runs.resize(count);
  for (std::size_t i = 0; i < count; ++i) m.runs[i] = load<std::uint32_t>(at + kMaskHead + 4 * i);
  if (!is_sane(m)) return bad(MessageType::mask, "has runs that do not sum to its size");
  return m;
}

// The least size of a fixed body; 0 for JSON.
std::size_t fixed_size(MessageType type) {
  switch (type) {
    case MessageType::heartbeat:
    case MessageType::frame_done:
      return 16;
    case MessageType::clock_request:
    case MessageType::acknowledge:
      return 8;
    case MessageType::clock_response:
    case MessageType::mask:
      return 24;
    case MessageType::video:
      return kVideoHead;
    case MessageType::pose:
      return kPoseSize;
    default:
      return 0;
  }
}

Result<Message> read_fixed(MessageType type, ByteView body) {
  if (body.size() < fixed_size(type)) return bad(type, "is too short");
  const std::uint8_t* at = body.data();
  switch (type) {
    case MessageType::heartbeat:
      return Heartbeat{load<std::uint32_t>(at), load<std::uint64_t>(at + 8)};
    case MessageType::clock_request:
      return ClockRequest{load<std::int64_t>(at)};
    case MessageType::clock_response:
      return ClockResponse{load<std::int64_t>(at), load<std::int64_t>(at + 8), load<std::int64_t>(at + 16)};
    case MessageType::acknowledge:
      return Acknowledge{load<std::uint64_t>(at)};
    case MessageType::frame_done:
      return FrameDone{stamp_at(at)};
    case MessageType::pose:
      return read_pose(body);
    case MessageType::video:
      return read_video(body);
    case MessageType::mask:
      return read_mask(body);
    default:
      return failure(ErrorCode::internal, "not a fixed message");
  }
}

template <class T>
Result<Message> read_json(ByteView body) {
  return from_json_text<T>(std::string_view(reinterpret_cast<const char*>(body.data()), body.size())).map([](T value) {
    return Message(std::move(value));
  });
}

template <class T>
Result<void> encode_json(const T& message, Bytes& out) {
  const nlohmann::json object = to_json(message);
  if (auto good = from_json<T>(object); !good) return tl::make_unexpected(good.error());
  const std::string text = object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  out.assign(text.begin(), text.end());
  return {};
}

template <class T>
Result<void> encode_fixed(const T& message, Bytes& out) {
  if constexpr (std::is_same_v<T, PoseEstimate> || std::is_same_v<T, Mask>) {
    if (!is_sane(message)) return bad(type_of(message), "has numbers out of range");
  } else if constexpr (std::is_same_v<T, VideoFrame>) {
    if (!is_sane(message.codec, message.width, message.height, message.stride, message.bytes.size())) {
      return bad(MessageType::video, "has a size that does not fit its codec");
    }
  }
  if constexpr (!std::is_same_v<T, PoseEstimate>) out.clear();  // a pose is written over what is there
  put(out, message);
  return {};
}

}  // namespace

Result<void> encode(const Message& message, Bytes& out) {
  auto encoded = std::visit(
      [&out](const auto& m) -> Result<void> {
        if constexpr (is_fixed<std::decay_t<decltype(m)>>) {
          return encode_fixed(m, out);
        } else {
          return encode_json(m, out);
        }
      },
      message);
  const MessageType type = type_of(message);
  if (encoded && out.size() > max_length(static_cast<std::uint16_t>(type))) {
    return failure(ErrorCode::limit_exceeded, "a " + std::string(name_of(type)) + " message has " +
                                                  std::to_string(out.size()) + " bytes, more than the " +
                                                  std::to_string(max_length(static_cast<std::uint16_t>(type))) +
                                                  " permitted");
  }
  return encoded;
}

Result<Bytes> encode(const Message& message) {
  Bytes out;
  if (auto encoded = encode(message, out); !encoded) return tl::make_unexpected(encoded.error());
  return out;
}

bool is_known(std::uint16_t type) {
  return !name_of(static_cast<MessageType>(type)).empty();
}

bool is_json(MessageType type) {
  return fixed_size(type) == 0;
}

Result<Message> decode(MessageType type, ByteView body) {
  switch (type) {
    case MessageType::hello:
      return read_json<Hello>(body);
    case MessageType::welcome:
      return read_json<Welcome>(body);
    case MessageType::error:
      return read_json<ErrorReport>(body);
    case MessageType::bye:
      return read_json<Bye>(body);
    case MessageType::challenge:
      return read_json<Challenge>(body);
    case MessageType::proof:
      return read_json<Proof>(body);
    case MessageType::intrinsics:
      return read_json<Intrinsics>(body);
    case MessageType::debug:
      return read_json<DebugView>(body);
    case MessageType::board_state:
      return read_json<BoardState>(body);
    case MessageType::game_event:
      return read_json<GameEvent>(body);
    case MessageType::control:
      return read_json<Control>(body);
    case MessageType::scene:
      return read_json<Scene>(body);
    case MessageType::command:
      return read_json<Command>(body);
    case MessageType::feedback:
      return read_json<Feedback>(body);
    default:
      return read_fixed(type, body);
  }
}

Result<Message> decode(MessageType type, Bytes&& body) {
  return type == MessageType::video ? take_video(std::move(body)) : decode(type, ByteView(body));
}

FrameId frame_of(const Message& message) {
  return std::visit(
      [](const auto& m) -> FrameId {
        if constexpr (requires { m.stamp.frame_id; }) {
          return m.stamp.frame_id;
        } else {
          return 0;
        }
      },
      message);
}

}  // namespace counterpart
