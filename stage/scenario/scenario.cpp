#include "stage/scenario/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>
#include <utility>
#include <vector>

#include "stage/scenario/located_json.hpp"

namespace counterpart::stage {
namespace {

using nlohmann::json;

// A value with its place. All checks of a scenario go through it, so that they all complain in the same way.
class Node {
 public:
  Node(const json& value, std::string path, const LocatedJson& source)
      : value_(value), path_(std::move(path)), source_(source) {}

  std::string where() const {
    const auto line = source_.line_of.find(path_);
    return (line == source_.line_of.end() ? std::string() : "line " + std::to_string(line->second) + ": ") +
           (path_.empty() ? "the scenario" : "\"" + path_.substr(1) + "\"");
  }
  tl::unexpected<Error> complain(const std::string& allowed) const {
    return failure(ErrorCode::bad_format, where() + " must be " + allowed + ", not " + value_.dump().substr(0, 60));
  }

  using Reader = std::function<Result<void>(const Node&)>;
  using Keys = std::vector<std::pair<std::string, Reader>>;

  Result<void> object(const Keys& keys) const {
    if (!value_.is_object()) return complain("an object");
    for (const auto& [name, child] : value_.items()) {
      const Node node(child, path_ + "/" + name, source_);
      const auto known =
          std::find_if(keys.begin(), keys.end(), [&wanted = name](const auto& key) { return key.first == wanted; });
      if (known == keys.end()) {
        std::string names;
        for (const auto& key : keys) names += (names.empty() ? "" : ", ") + key.first;
        return failure(ErrorCode::bad_format, node.where() + " is not a known key; known here: " + names);
      }
      if (const Result<void> read = known->second(node); !read) return read;
    }
    return {};
  }

  Result<void> array(const Reader& element) const {
    if (!value_.is_array()) return complain("an array");
    for (std::size_t i = 0; i < value_.size(); ++i) {
      if (const Result<void> read = element(Node(value_[i], path_ + "/" + std::to_string(i), source_)); !read)
        return read;
    }
    return {};
  }

  Result<void> number(double& target, double low, double high) const {
    if (!value_.is_number() || !(value_.get<double>() >= low && value_.get<double>() <= high)) {
      std::ostringstream range;
      range << "a number from " << low << " to " << high;
      return complain(range.str());
    }
    target = value_.get<double>();
    return {};
  }

  template <class Whole>
  Result<void> whole(Whole& target, std::int64_t low, std::int64_t high) const {
    if (!value_.is_number_integer() || value_.get<std::int64_t>() < low || value_.get<std::int64_t>() > high) {
      return complain("a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    }
    target = static_cast<Whole>(value_.get<std::int64_t>());
    return {};
  }

  Result<void> flag(bool& target) const {
    if (!value_.is_boolean()) return complain("true or false");
    target = value_.get<bool>();
    return {};
  }

  Result<void> text(std::string& target) const {
    if (!value_.is_string()) return complain("a text");
    target = value_.get<std::string>();
    return {};
  }

  template <class Choice>
  Result<void> choice(Choice& target, const std::vector<std::pair<std::string, Choice>>& choices) const {
    std::string names;
    for (const auto& [name, chosen] : choices) {
      if (value_.is_string() && value_.get<std::string>() == name) {
        target = chosen;
        return {};
      }
      names += (names.empty() ? "\"" : ", \"") + name + "\"";
    }
    return complain("one of " + names);
  }

  template <class Numbers>
  Result<void> numbers(Numbers& target, std::size_t count, double low, double high) const {
    if (!value_.is_array() || value_.size() != count)
      return complain("an array of " + std::to_string(count) + " numbers");
    for (std::size_t i = 0; i < count; ++i) {
      double number_read = 0;
      const Node element(value_[i], path_ + "/" + std::to_string(i), source_);
      if (const Result<void> read = element.number(number_read, low, high); !read) return read;
      target[static_cast<int>(i)] = number_read;
    }
    return {};
  }

 private:
  const json& value_;
  std::string path_;
  const LocatedJson& source_;
};

using Reader = Node::Reader;

Reader number(double& target, double low, double high) {
  return [&target, low, high](const Node& node) { return node.number(target, low, high); };
}
template <class Whole>
Reader whole(Whole& target, std::int64_t low, std::int64_t high) {
  return [&target, low, high](const Node& node) { return node.whole(target, low, high); };
}
Reader flag(bool& target) {
  return [&target](const Node& node) { return node.flag(target); };
}
Reader text(std::string& target) {
  return [&target](const Node& node) { return node.text(target); };
}
Reader point(Eigen::Vector3d& target) {
  return [&target](const Node& node) { return node.numbers(target, 3, -20, 20); };
}
Reader object(Node::Keys keys) {
  return [keys = std::move(keys)](const Node& node) { return node.object(keys); };
}

constexpr double kDegree = 0.017453292519943295;

Reader degrees(double& target_rad, double low, double high) {
  return [&target_rad, low, high](const Node& node) {
    Result<void> read = node.number(target_rad, low, high);
    target_rad *= kDegree;
    return read;
  };
}

Reader millimetres(double& target_m, double low, double high) {
  return [&target_m, low, high](const Node& node) {
    Result<void> read = node.number(target_m, low, high);
    target_m /= 1000;
    return read;
  };
}

Reader camera_keys(Scenario& s, double& sweep_radius_px) {
  Intrinsics& k = s.intrinsics;
  return object({
      {"width", whole(k.width, 160, 1920)},
      {"height", whole(k.height, 120, 1080)},
      {"fps", number(s.fps, 1, 120)},
      {"focal_px",
       [&k](const Node& node) {
         const Result<void> read = node.number(k.fx, 50, 10000);
         k.fy = k.fx;
         return read;
       }},
      {"distortion", [&k](const Node& node) { return node.numbers(k.dist, 5, -1, 1); }},
      {"eye_m", point(s.path.eye_R)},
      {"target_m", point(s.path.target_R)},
      {"dolly_to_m",
       [&s](const Node& node) {
         s.path.dolly_to_R = Eigen::Vector3d::Zero();
         return node.numbers(*s.path.dolly_to_R, 3, -20, 20);
       }},
      {"dolly_period_s", number(s.path.dolly_period_s, 0.5, 1000)},
      {"sweep_px_per_frame", number(s.path.sweep_rad_s, 0, 200)},
      {"sweep_radius_px", number(sweep_radius_px, 10, 1000)},
      {"zoom_range",
       [&s](const Node& node) {
         Eigen::Vector2d range(1, 1);
         Result<void> read = node.numbers(range, 2, 0.2, 5);
         if (read && !(range[0] <= 1 && range[1] >= 1))
           return Result<void>(node.complain("two factors with 1 between"));
         s.path.zoom_low = range[0];
         s.path.zoom_high = range[1];
         return read;
       }},
      {"zoom_period_s", number(s.path.zoom_period_s, 0.5, 1000)},
      {"orbit_deg", degrees(s.path.orbit_rad, 0, 180)},
      {"orbit_period_s", number(s.path.orbit_period_s, 0.5, 1000)},
      {"shake_mm", millimetres(s.path.shake_m, 0, 100)},
      {"shake_deg", degrees(s.path.shake_rad, 0, 10)},
      {"blur_px", number(s.sensor.blur_px, 0, 5)},
      {"noise", number(s.sensor.noise, 0, 30)},
      {"exposure_drift_ev", number(s.sensor.exposure_drift_ev, 0, 3)},
      {"white_drift", number(s.sensor.white_drift, 0, 0.5)},
      {"drift_period_s", number(s.sensor.drift_period_s, 0.5, 1000)},
      {"jpeg_quality", whole(s.sensor.jpeg_quality, 1, 100)},
      {"shutter_ms", millimetres(s.shutter.open_s, 0, 40)},
      {"rolling_ms", millimetres(s.shutter.readout_s, 0, 40)},
      {"interlaced", flag(s.shutter.interlaced)},
  });
}

Reader board_keys(Scenario& s) {
  return object({
      {"squares",
       [&s](const Node& node) {
         const Result<void> read = node.whole(s.board.squares, 8, 10);
         if (read && s.board.squares == 9) return Result<void>(node.complain("8 or 10"));
         return read;
       }},
      {"square_mm", millimetres(s.board.square_size_m, 10, 100)},
      {"border_mm", millimetres(s.board.border_m, 0, 100)},
      {"thickness_mm", millimetres(s.board.thickness_m, 1, 60)},
      {"piece_diameter_mm",
       [&s](const Node& node) {
         const Result<void> read = node.number(s.board.piece_radius_m, 5, 100);
         s.board.piece_radius_m /= 2000;
         return read;
       }},
      {"piece_height_mm", millimetres(s.board.piece_height_m, 1, 40)},
      {"warp_mm", millimetres(s.warp_m, 0, 5)},
      {"empty", flag(s.no_pieces)},
      {"present",
       [&s](const Node& node) {
         bool present = true;
         const Result<void> read = node.flag(present);
         s.no_board = !present;
         return read;
       }},
      {"played_on",
       [&s](const Node& node) {
         return node.choice<SquareColour>(s.board.played_on,
                                          {{"dark", SquareColour::dark}, {"light", SquareColour::light}});
       }},
  });
}

Result<void> read_illegal_move(const Node& node, Scenario& s) {
  IllegalMove illegal;
  const Result<void> read = node.object({
      {"at_move", whole(illegal.at_move, 1, 500)},
      {"kind",
       [&illegal](const Node& kind) {
         return kind.choice<IllegalKind>(illegal.kind, {{"backwards", IllegalKind::backwards},
                                                        {"sideways", IllegalKind::sideways},
                                                        {"too_far", IllegalKind::too_far},
                                                        {"wrong_piece", IllegalKind::wrong_piece},
                                                        {"two_pieces", IllegalKind::two_pieces}});
       }},
  });
  if (read) s.player.illegal_moves.push_back(illegal);
  return read;
}

Result<void> read_event(const Node& node, Scenario& s) {
  Event event;
  const Result<void> read = node.object({
      {"kind",
       [&event](const Node& kind) {
         return kind.choice<EventKind>(event.kind, {{"lights", EventKind::lights},
                                                    {"nudge_board", EventKind::nudge_board},
                                                    {"bump_camera", EventKind::bump_camera},
                                                    {"look_away", EventKind::look_away},
                                                    {"cup", EventKind::cup},
                                                    {"defocus", EventKind::defocus},
                                                    {"cover", EventKind::cover}});
       }},
      {"at_s", number(event.at_s, 0, 1e5)},
      {"for_s", number(event.for_s, 0.05, 1e5)},
      {"level", number(event.level, 0, 1.5)},
      {"by_mm",
       [&event](const Node& by) {
         const Result<void> numbers = by.numbers(event.by_m, 2, -1000, 1000);
         event.by_m /= 1000;
         return numbers;
       }},
      {"turn_deg", degrees(event.turn_rad, -180, 180)},
      {"blur_px", number(event.blur_px, 0, 20)},
      {"share", number(event.share, 0, 0.95)},
  });
  if (read) s.events.push_back(event);
  return read;
}

Result<void> read_name(const Node& node, const Scenario& s, std::string& target) {
  const Result<void> read = node.text(target);
  if (!read) return read;
  const bool plain = !target.empty() && target.size() <= 32 && std::all_of(target.begin(), target.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (!plain) return node.complain("1 to 32 letters, digits and _ (a folder is named so)");
  for (const ObjectPlan& other : s.objects) {
    if (other.name == target) return node.complain("a name that no other object has");
  }
  return {};
}

Result<void> read_object(const Node& node, Scenario& s) {
  ObjectPlan plan;
  plan.name = "object" + std::to_string(s.objects.size() + 1);
  bool sized = false, placed = false;
  Result<void> read = node.object({
      {"name", [&](const Node& name) { return read_name(name, s, plan.name); }},
      {"kind",
       [&](const Node& kind) {
         return kind.choice<ObjectKind>(
             plan.kind, {{"box", ObjectKind::box}, {"table", ObjectKind::table}, {"chair", ObjectKind::chair}});
       }},
      {"size_mm",
       [&](const Node& size) {
         const Result<void> numbers = size.numbers(plan.size_m, 3, 20, 2000);
         plan.size_m /= 1000;
         sized = true;
         return numbers;
       }},
      {"on",
       [&](const Node& on) {
         placed = true;
         return on.choice<bool>(plan.on_floor, {{"table", false}, {"floor", true}});
       }},
      {"at_mm",
       [&](const Node& at) {
         const Result<void> numbers = at.numbers(plan.place_R_m, 2, -3000, 3000);
         plan.place_R_m /= 1000;
         return numbers;
       }},
      {"turn_deg", degrees(plan.turn_rad, -180, 180)},
      {"by_mm",
       [&](const Node& by) {
         const Result<void> numbers = by.numbers(plan.by_m, 2, -1000, 1000);
         plan.by_m /= 1000;
         return numbers;
       }},
      {"swing_deg", degrees(plan.swing_rad, -180, 180)},
      {"period_s", number(plan.period_s, 0.5, 1000)},
  });
  if (!read) return read;
  if (!placed) plan.on_floor = plan.kind != ObjectKind::box;
  if (!sized) plan.size_m = usual_size_m(plan.kind);
  const Eigen::Vector3d least = plan.kind == ObjectKind::box     ? Eigen::Vector3d(0.02, 0.02, 0.02)
                                : plan.kind == ObjectKind::table ? Eigen::Vector3d(0.15, 0.15, 0.10)
                                                                 : Eigen::Vector3d(0.15, 0.15, 0.20);
  if ((plan.size_m.array() < least.array() - 1e-12).any()) {
    return node.complain("no smaller than 150 x 150 x 100 mm (a table) or 150 x 150 x 200 mm (a chair)");
  }
  if (plan.on_floor && (plan.by_m.norm() > 0 || plan.swing_rad != 0)) {
    return node.complain("without by_mm and swing_deg on the floor: only what is on the table moves");
  }
  s.objects.push_back(plan);
  return {};
}

Result<void> read_rest(const Node& node, Scenario& s) {
  HandRest rest;
  const Result<void> read = node.object({
      {"at_s", number(rest.at_s, 0, 1e5)},
      {"for_s", number(rest.for_s, 0.1, 1e5)},
      {"place_mm",
       [&rest](const Node& place) {
         const Result<void> numbers = place.numbers(rest.place_m, 2, -300, 300);
         rest.place_m /= 1000;
         return numbers;
       }},
  });
  if (read) s.player.rests.push_back(rest);
  return read;
}

Result<void> read_knock(const Node& node, Scenario& s) {
  int at_move = 1;
  const Result<void> read = node.whole(at_move, 1, 500);
  if (read) s.player.knocks_over.push_back(at_move);
  return read;
}

Reader player_keys(Scenario& s) {
  return object({
      {"present", flag(s.player_present)},
      {"figure", text(s.player_figure)},
      {"practise", flag(s.player.practise)},
      {"speed", number(s.player.speed, 0.1, 5)},
      {"forgets_s", number(s.player.forgets_s, 0, 600)},
      {"knocks_over",
       [&s](const Node& node) { return node.array([&s](const Node& move) { return read_knock(move, s); }); }},
      {"hand_rests",
       [&s](const Node& node) { return node.array([&s](const Node& element) { return read_rest(element, s); }); }},
      {"illegal_moves",
       [&s](const Node& node) {
         return node.array([&s](const Node& element) { return read_illegal_move(element, s); });
       }},
  });
}

}  // namespace

void reseed(Scenario& scenario, std::uint64_t seed) {
  scenario.seed = seed;
  scenario.path.seed = seed * 31 + 1;
  scenario.player.seed = seed * 31 + 2;
}

Result<Scenario> parse_scenario(const std::string& content) {
  const Result<LocatedJson> source = parse_located(content);
  if (!source) return tl::make_unexpected(source.error());
  Scenario s;
  double sweep_radius_px = 140;
  const Node root(source->value, "", *source);
  const Result<void> read = root.object({
      {"name", text(s.name)},
      {"about", text(s.about)},
      {"seed", whole(s.seed, 0, 1'000'000'000)},
      {"frames", whole(s.frames, 1, 1'000'000)},
      {"light", number(s.light, 0, 1.5)},
      {"camera", camera_keys(s, sweep_radius_px)},
      {"board", board_keys(s)},
      {"player", player_keys(s)},
      {"objects",
       [&s](const Node& node) { return node.array([&s](const Node& element) { return read_object(element, s); }); }},
      {"events",
       [&s](const Node& node) { return node.array([&s](const Node& element) { return read_event(element, s); }); }},
  });
  if (!read) return tl::make_unexpected(read.error());
  if (s.objects.size() > 16) return failure(ErrorCode::bad_format, "\"objects\": 16 at most");
  if (s.no_board && (s.objects.empty() || s.player_present)) {
    return failure(ErrorCode::bad_format,
                   "\"board\": without a board (\"present\": false) there must be \"objects\", and no player "
                   "(\"player\": {\"present\": false})");
  }
  // The angles of a sweep follow from the lens.
  s.path.sweep_rad_s *= s.fps / s.intrinsics.fx;
  s.path.sweep_radius_rad = sweep_radius_px / s.intrinsics.fx;
  if (s.shutter.open_s + std::max(s.shutter.readout_s, s.shutter.interlaced ? 0.5 / s.fps : 0.0) > 1 / s.fps) {
    return failure(ErrorCode::bad_format,
                   "\"camera\": shutter_ms and rolling_ms (or the half period between fields) must "
                   "fit into the time between two frames");
  }
  s.intrinsics.cx = (s.intrinsics.width - 1) / 2.0;
  s.intrinsics.cy = (s.intrinsics.height - 1) / 2.0;
  reseed(s, s.seed);
  return s;
}

Result<Scenario> load_scenario(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (!file || !(content << file.rdbuf())) {
    return failure(ErrorCode::not_found, "The scenario " + path +
                                             " cannot be read; give a JSON file such as those in "
                                             "stage/scenarios.");
  }
  Result<Scenario> scenario = parse_scenario(content.str());
  if (!scenario) return failure(scenario.error().code, path + ", " + scenario.error().message);
  return scenario;
}

}  // namespace counterpart::stage
