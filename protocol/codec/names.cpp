#include "protocol/codec/names.hpp"

#include <array>
#include <utility>

namespace counterpart {
namespace {

template <class E>
struct Names;

template <class E, std::size_t N>
using Table = std::array<std::pair<E, std::string_view>, N>;

template <>
struct Names<MessageType> {
  static constexpr Table<MessageType, 22> table{{
      {MessageType::hello, "hello"},
      {MessageType::welcome, "welcome"},
      {MessageType::heartbeat, "heartbeat"},
      {MessageType::error, "error"},
      {MessageType::bye, "bye"},
      {MessageType::clock_request, "clock_request"},
      {MessageType::clock_response, "clock_response"},
      {MessageType::acknowledge, "acknowledge"},
      {MessageType::challenge, "challenge"},
      {MessageType::proof, "proof"},
      {MessageType::intrinsics, "intrinsics"},
      {MessageType::pose, "pose"},
      {MessageType::video, "video"},
      {MessageType::mask, "mask"},
      {MessageType::debug, "debug"},
      {MessageType::frame_done, "frame_done"},
      {MessageType::board_state, "board_state"},
      {MessageType::game_event, "game_event"},
      {MessageType::control, "control"},
      {MessageType::scene, "scene"},
      {MessageType::command, "command"},
      {MessageType::feedback, "feedback"},
  }};
};

template <>
struct Names<Role> {
  static constexpr Table<Role, 5> table{{
      {Role::camera, "camera"},
      {Role::tracker, "tracker"},
      {Role::renderer, "renderer"},
      {Role::observer, "observer"},
      {Role::director, "director"},
  }};
};

template <>
struct Names<Side> {
  static constexpr Table<Side, 2> table{{{Side::light, "light"}, {Side::dark, "dark"}}};
};

template <>
struct Names<GamePhase> {
  static constexpr Table<GamePhase, 7> table{{
      {GamePhase::setting_up, "setting_up"},
      {GamePhase::real_to_move, "real_to_move"},
      {GamePhase::virtual_to_move, "virtual_to_move"},
      {GamePhase::waiting_for_removal, "waiting_for_removal"},
      {GamePhase::illegal, "illegal"},
      {GamePhase::paused, "paused"},
      {GamePhase::over, "over"},
  }};
};

template <>
struct Names<GameResult> {
  static constexpr Table<GameResult, 4> table{{
      {GameResult::open, "open"},
      {GameResult::light_wins, "light_wins"},
      {GameResult::dark_wins, "dark_wins"},
      {GameResult::draw, "draw"},
  }};
};

template <>
struct Names<EventKind> {
  static constexpr Table<EventKind, 13> table{{
      {EventKind::game_started, "game_started"},
      {EventKind::move, "move"},
      {EventKind::illegal_move, "illegal_move"},
      {EventKind::captured, "captured"},
      {EventKind::promoted, "promoted"},
      {EventKind::waiting_for_removal, "waiting_for_removal"},
      {EventKind::removal_done, "removal_done"},
      {EventKind::turn, "turn"},
      {EventKind::board_unclear, "board_unclear"},
      {EventKind::board_restored, "board_restored"},
      {EventKind::set_up_wrong, "set_up_wrong"},
      {EventKind::game_over, "game_over"},
      {EventKind::undone, "undone"},
  }};
};

template <>
struct Names<ControlKind> {
  static constexpr Table<ControlKind, 12> table{{
      {ControlKind::new_game, "new_game"},
      {ControlKind::undo, "undo"},
      {ControlKind::resign, "resign"},
      {ControlKind::pause, "pause"},
      {ControlKind::resume, "resume"},
      {ControlKind::read_again, "read_again"},
      {ControlKind::it_was, "it_was"},
      {ControlKind::level, "level"},
      {ControlKind::swap_sides, "swap_sides"},
      {ControlKind::corners, "corners"},
      {ControlKind::hint, "hint"},
      {ControlKind::quit, "quit"},
  }};
};

template <>
struct Names<Hand> {
  static constexpr Table<Hand, 3> table{{{Hand::any, "any"}, {Hand::left, "left"}, {Hand::right, "right"}}};
};

template <>
struct Names<BodyPart> {
  static constexpr Table<BodyPart, 7> table{{
      {BodyPart::whole, "whole"},
      {BodyPart::upper, "upper"},
      {BodyPart::head, "head"},
      {BodyPart::left_arm, "left_arm"},
      {BodyPart::right_arm, "right_arm"},
      {BodyPart::face, "face"},
      {BodyPart::legs, "legs"},
  }};
};

template <>
struct Names<GazeTarget> {
  static constexpr Table<GazeTarget, 6> table{{
      {GazeTarget::square, "square"},
      {GazeTarget::piece, "piece"},
      {GazeTarget::player, "player"},
      {GazeTarget::camera, "camera"},
      {GazeTarget::point, "point"},
      {GazeTarget::ahead, "ahead"},
  }};
};

template <>
struct Names<FeedbackState> {
  static constexpr Table<FeedbackState, 6> table{{
      {FeedbackState::accepted, "accepted"},
      {FeedbackState::started, "started"},
      {FeedbackState::progress, "progress"},
      {FeedbackState::finished, "finished"},
      {FeedbackState::failed, "failed"},
      {FeedbackState::cancelled, "cancelled"},
  }};
};

template <>
struct Names<SquareColour> {
  static constexpr Table<SquareColour, 2> table{{{SquareColour::dark, "dark"}, {SquareColour::light, "light"}}};
};

template <>
struct Names<TrackStatus> {
  static constexpr Table<TrackStatus, 4> table{{
      {TrackStatus::ok, "ok"},
      {TrackStatus::coasting, "coasting"},
      {TrackStatus::lost, "lost"},
      {TrackStatus::relocalised, "relocalised"},
  }};
};

template <>
struct Names<PixelCodec> {
  static constexpr Table<PixelCodec, 3> table{
      {{PixelCodec::raw_bgr8, "raw_bgr8"}, {PixelCodec::jpeg, "jpeg"}, {PixelCodec::h264, "h264"}}};
};

template <>
struct Names<ErrorCode> {
  static constexpr Table<ErrorCode, 13> table{{
      {ErrorCode::invalid_argument, "invalid_argument"},
      {ErrorCode::not_found, "not_found"},
      {ErrorCode::io, "io"},
      {ErrorCode::bad_format, "bad_format"},
      {ErrorCode::unsupported, "unsupported"},
      {ErrorCode::version_mismatch, "version_mismatch"},
      {ErrorCode::timeout, "timeout"},
      {ErrorCode::closed, "closed"},
      {ErrorCode::refused, "refused"},
      {ErrorCode::not_a_number, "not_a_number"},
      {ErrorCode::limit_exceeded, "limit_exceeded"},
      {ErrorCode::unavailable, "unavailable"},
      {ErrorCode::internal, "internal"},
  }};
};

// In the order of the variant's alternatives.
constexpr std::array<std::string_view, 7> kVerbs{"grasp", "keyframe", "navigate", "gaze", "say", "express", "stop"};
static_assert(kVerbs.size() == std::variant_size_v<Action>);

}  // namespace

template <class E>
std::string_view name_of(E value) {
  for (const auto& [known, name] : Names<E>::table) {
    if (known == value) return name;
  }
  return "";
}

template <class E>
std::optional<E> from_name(std::string_view name) {
  for (const auto& [known, word] : Names<E>::table) {
    if (word == name) return known;
  }
  return std::nullopt;
}

template <class E>
std::string all_names() {
  std::string list;
  for (const auto& [known, name] : Names<E>::table) {
    if (!list.empty()) list += ", ";
    list += name;
  }
  return list;
}

std::string_view verb_of(const Action& action) {
  return kVerbs.at(action.index());
}

#define COUNTERPART_NAMES(E)                                     \
  template std::string_view name_of<E>(E value);                 \
  template std::optional<E> from_name<E>(std::string_view name); \
  template std::string all_names<E>()

COUNTERPART_NAMES(MessageType);
COUNTERPART_NAMES(Role);
COUNTERPART_NAMES(Side);
COUNTERPART_NAMES(GamePhase);
COUNTERPART_NAMES(GameResult);
COUNTERPART_NAMES(EventKind);
COUNTERPART_NAMES(ControlKind);
COUNTERPART_NAMES(Hand);
COUNTERPART_NAMES(BodyPart);
COUNTERPART_NAMES(GazeTarget);
COUNTERPART_NAMES(FeedbackState);
COUNTERPART_NAMES(SquareColour);
COUNTERPART_NAMES(TrackStatus);
COUNTERPART_NAMES(PixelCodec);
COUNTERPART_NAMES(ErrorCode);

}  // namespace counterpart
