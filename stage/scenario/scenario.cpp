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
      const auto known = std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return key.first == name; });
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

Reader camera_keys(Scenario& s) {
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
      {"eye_m", point(s.path.eye_B)},
      {"target_m", point(s.path.target_B)},
      {"orbit_deg", degrees(s.path.orbit_rad, 0, 180)},
      {"orbit_period_s", number(s.path.orbit_period_s, 0.5, 1000)},
      {"shake_mm", millimetres(s.path.shake_m, 0, 100)},
      {"shake_deg", degrees(s.path.shake_rad, 0, 10)},
      {"blur_px", number(s.sensor.blur_px, 0, 5)},
      {"noise", number(s.sensor.noise, 0, 30)},
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
      {"empty", flag(s.no_pieces)},
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
                                                        {"two_pieces", IllegalKind::two_pieces}});
       }},
  });
  if (read) s.player.illegal_moves.push_back(illegal);
  return read;
}

Reader player_keys(Scenario& s) {
  return object({
      {"present", flag(s.player_present)},
      {"practise", flag(s.player.practise)},
      {"speed", number(s.player.speed, 0.1, 5)},
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
  const Node root(source->value, "", *source);
  const Result<void> read = root.object({
      {"name", text(s.name)},
      {"about", text(s.about)},
      {"seed", whole(s.seed, 0, 1'000'000'000)},
      {"frames", whole(s.frames, 1, 1'000'000)},
      {"light", number(s.light, 0, 1.5)},
      {"camera", camera_keys(s)},
      {"board", board_keys(s)},
      {"player", player_keys(s)},
  });
  if (!read) return tl::make_unexpected(read.error());
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
