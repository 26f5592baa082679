// tracker_server track as its users run it, with good and with bad input.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/program.hpp"
#include "tests/tracker_server/support/board_picture.hpp"
#include "tests/tracker_server/support/cube_picture.hpp"
#include "tracker_server/camera/camera_json.hpp"

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing_support::Outcome;
using testing_support::run;
using testing_support::TemporaryFolder;

namespace fs = std::filesystem;

void write_start(const Isometry3d& X_CM, const std::string& file) {
  const Eigen::Quaterniond q(X_CM.linear());
  const Vector3d t = X_CM.translation();
  std::ofstream(file) << nlohmann::json{{"frame", 0},  {"tx", t.x()}, {"ty", t.y()}, {"tz", t.z()},
                                        {"qw", q.w()}, {"qx", q.x()}, {"qy", q.y()}, {"qz", q.z()}};
}

void write_picture(const cv::Mat& picture, const std::string& folder, int frame) {
  std::ostringstream name;
  name << folder << "/frame_" << std::setw(5) << std::setfill('0') << frame << ".png";
  cv::imwrite(name.str(), picture);
}

// Three pictures of a board with a box that stands beside it; small, so that painting takes no time.
struct BoardFilm {
  TemporaryFolder folder;
  test::BoardScene scene;
  Isometry3d X_BM = Isometry3d::Identity();

  BoardFilm() {
    scene.camera = test::camera_720x576(700);
    scene.table_bgr = {215, 215, 210};  // unlike any face of the box
    X_BM.translation() = Vector3d(0.34, 0.02, test::cube_half_m);
    const Isometry3d X_CB = X_at(0);
    EXPECT_TRUE(write_camera_json(folder.path("camera.json"), scene.camera));
    write_start(X_CB, folder.path("init.json"));
    fs::create_directories(folder.path("objects/box"));
    std::ofstream(folder.path("objects/box/model.obj")) << test::cube_obj();
    write_start(X_CB * X_BM, folder.path("objects/box/init.json"));
    for (int frame = 0; frame < 3; ++frame) {
      scene.X_CB = X_at(frame);
      cv::Mat picture = test::paint(scene, 2);
      test::paint_cube(scene.camera, scene.X_CB * X_BM, picture);
      write_picture(picture, folder.folder(), frame);
    }
  }
  Isometry3d X_at(int frame) const { return test::looking_at_board(1.1, 0.8, 0.1 + 0.004 * frame); }
};

// Rows of a poses.csv by column name.
std::vector<std::map<std::string, std::string>> read_csv(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    rows.emplace_back();
    for (std::size_t i = 0; i < cells.size() && i < names.size(); ++i) rows.back()[names[i]] = cells[i];
  }
  return rows;
}

Isometry3d pose_in(const std::map<std::string, std::string>& row) {
  const auto number = [&](const char* name) { return std::stod(row.at(name)); };
  Isometry3d X = Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond(number("qw"), number("qx"), number("qy"), number("qz")).toRotationMatrix();
  X.translation() = Vector3d(number("tx"), number("ty"), number("tz"));
  return X;
}

TEST(Track, WritesThePosesOfTheBoardAndOfObjectsRigidToItOrNot) {
  const BoardFilm film;
  for (const bool rigid : {false, true}) {
    std::vector<std::string> arguments = {"track",    film.folder.folder(),
                                          "--poses",  film.folder.path("out.csv"),
                                          "--object", "box",
                                          "--report", film.folder.path("report.json"),
                                          "--debug",  film.folder.path("debug")};
    if (rigid) arguments.insert(arguments.end(), {"--rigid", "board,box"});
    const Outcome outcome = run("tracker_server", arguments);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto board = read_csv(film.folder.path("out.csv")), box = read_csv(film.folder.path("out.box.csv"));
    ASSERT_EQ(board.size(), 3U);
    ASSERT_EQ(box.size(), 3U);
    for (int frame = 0; frame < 3; ++frame) {
      const auto i = static_cast<std::size_t>(frame);
      ASSERT_EQ(board[i].at("status"), "ok");
      ASSERT_EQ(box[i].at("status"), "ok");
      const Isometry3d X_CB = film.X_at(frame);
      // Of the whole board a tenth of a pixel is asked elsewhere; here it is enough that it is this board's pose.
      EXPECT_LT(
          test::farthest_crossing_px(film.scene.board, film.scene.camera, pose_in(board[i]), film.scene.camera, X_CB),
          0.5);
      // A box of 65 pixels alone is told less well at its corners that are not seen.
      EXPECT_LT(test::farthest_cube_corner_px(film.scene.camera, pose_in(box[i]), X_CB * film.X_BM), rigid ? 0.5 : 3.0);
      EXPECT_TRUE(fs::exists(film.folder.path("debug/frame_0000" + std::to_string(frame) + ".png")));
    }
    std::ifstream file(film.folder.path("report.json"));
    const nlohmann::json report = nlohmann::json::parse(file);
    EXPECT_EQ(report.at("ok"), 3);
    EXPECT_EQ(report.at("objects").at("box").at("ok"), 3);
    // The debug picture is the film's with something drawn on it.
    const cv::Mat plain = cv::imread(film.folder.path("frame_00001.png"));
    const cv::Mat drawn = cv::imread(film.folder.path("debug/frame_00001.png"));
    cv::Mat changed;
    cv::absdiff(plain, drawn, changed);
    EXPECT_GT(cv::countNonZero(changed.reshape(1) > 40), 2000);
  }
}

TEST(Track, SaysWhatIsWrongWithObjects) {
  const BoardFilm film;
  const auto failing = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"track", film.folder.folder(), "--poses", film.folder.path("out.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run("tracker_server", arguments);
    EXPECT_NE(outcome.exit_code, 0);
    return outcome.err;
  };
  EXPECT_NE(failing({"--object", "cup"}).find("objects/cup/model.obj"), std::string::npos);
  EXPECT_NE(failing({"--object", "box", "--object", "box"}).find("\"box\" already"), std::string::npos);
  EXPECT_NE(failing({"--object", "box", "--rigid", "board,cup"}).find("\"cup\""), std::string::npos);
  EXPECT_NE(failing({"--object", "box", "--rigid", "box"}).find("at least two"), std::string::npos);
  fs::remove(film.folder.path("init.json"));
  EXPECT_NE(failing({"--object", "box", "--rigid", "board,box"}).find("init.json"), std::string::npos);
  fs::remove(film.folder.path("camera.json"));
  EXPECT_NE(failing({"--object", "box"}).find("camera.json"), std::string::npos);
}

TEST(Track, NamesTheLineOfABadModel) {
  const BoardFilm film;
  const std::string model = film.folder.path("bad.obj");
  const std::vector<std::string> arguments = {
      "track", film.folder.folder(), "--poses", film.folder.path("out.csv"), "--model", model};
  for (const char* text : {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n",
                           "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"}) {
    std::ofstream(model) << text;
    const Outcome outcome = run("tracker_server", arguments);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_NE(outcome.err.find("bad.obj, line "), std::string::npos) << outcome.err;
  }
}

TEST(Track, RefusesIntrinsicsThatAreNoNumbers) {
  const BoardFilm film;
  for (const char* fx : {"NaN", "null", "-500", "1e400"}) {
    std::ofstream(film.folder.path("camera.json")) << "{\"width\":720,\"height\":576,\"fx\":" << fx
                                                   << ",\"fy\":700,\"cx\":359.5,\"cy\":287.5,\"dist\":[0,0,0,0,0]}";
    const Outcome outcome =
        run("tracker_server", {"track", film.folder.folder(), "--poses", film.folder.path("out.csv")});
    EXPECT_NE(outcome.exit_code, 0) << fx;
    EXPECT_NE(outcome.err.find("camera.json"), std::string::npos) << outcome.err;
  }
}

TEST(Track, NamesAPictureThatIsCutOff) {
  const BoardFilm film;
  const std::string cut = film.folder.path("frame_00001.png");
  fs::resize_file(cut, fs::file_size(cut) / 3);
  const Outcome outcome =
      run("tracker_server", {"track", film.folder.folder(), "--poses", film.folder.path("out.csv")});
  const auto rows = read_csv(film.folder.path("out.csv"));
  // Either the film ends there with an error that names it, or what could be decoded is honestly judged.
  if (outcome.exit_code != 0) {
    EXPECT_NE(outcome.err.find("frame_00001.png"), std::string::npos) << outcome.err;
  } else {
    ASSERT_EQ(rows.size(), 3U);
    if (rows[1].at("status") == "ok") {
      EXPECT_LT(test::farthest_crossing_px(film.scene.board, film.scene.camera, pose_in(rows[1]), film.scene.camera,
                                           film.X_at(1)),
                2.0);
    }
  }
}

TEST(Track, APictureOfAnotherSizeThanTheCamerasIsNamed) {
  const BoardFilm film;
  const std::string second = film.folder.path("frame_00001.png");
  cv::Mat half;
  cv::resize(cv::imread(second), half, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::imwrite(second, half);
  const Outcome known = run("tracker_server", {"track", film.folder.folder(), "--poses", film.folder.path("out.csv")});
  EXPECT_EQ(known.exit_code, 1);
  EXPECT_NE(known.err.find("frame_00001.png"), std::string::npos) << known.err;
}

TEST(Track, ABoardLargerThanThePictureIsLostAndNotGuessed) {
  TemporaryFolder folder;
  test::BoardScene scene;
  scene.camera = test::camera_720x576(700);
  scene.X_CB = test::looking_at_board(0.12, 1.2, 0.1);  // three squares fill the picture
  ASSERT_TRUE(write_camera_json(folder.path("camera.json"), scene.camera));
  write_picture(test::paint(scene, 2), folder.folder(), 0);
  const Outcome outcome = run("tracker_server", {"track", folder.folder(), "--poses", folder.path("out.csv")});
  EXPECT_EQ(outcome.exit_code, 1);
  const auto rows = read_csv(folder.path("out.csv"));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].at("status"), "lost");
}

}  // namespace
}  // namespace counterpart
