#include "vhd_renderer/programs/backdrop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "protocol/codec/json.hpp"
#include "protocol/vocabulary/pose_eigen.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_text_bytes = 64U << 20U;

Result<std::string> text_of(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return failure(ErrorCode::not_found, "there is no " + file.string() + "; a sequence needs it");
  if (size > largest_text_bytes) return failure(ErrorCode::limit_exceeded, file.string() + " is too large");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Result<Intrinsics> read_camera(const fs::path& file) {
  const auto text = text_of(file);
  if (!text) return tl::make_unexpected(text.error());
  const auto value = nlohmann::json::parse(*text, nullptr, false);
  auto camera = from_json<Intrinsics>(value);
  if (!camera) return failure(camera.error().code, file.string() + ": " + camera.error().message);
  if (camera->width < 16 || camera->height < 16 || camera->width > 8192 || camera->height > 8192 || camera->fx <= 0) {
    return failure(ErrorCode::bad_format, file.string() + ": no camera has these numbers");
  }
  return camera;
}

// Lines of another status than ok or coasting, or without numbers, have no pose.
Result<std::map<std::size_t, Eigen::Isometry3d>> read_poses(const fs::path& file) {
  const auto text = text_of(file);
  if (!text) return tl::make_unexpected(text.error());
  std::map<std::size_t, Eigen::Isometry3d> poses;
  std::istringstream in(*text);
  std::string line;
  std::getline(in, line);  // the column names
  while (std::getline(in, line)) {
    if (line.find("lost") != std::string::npos) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    std::size_t frame = 0;
    Pose pose;
    fields >> frame;
    for (double& v : pose.p) fields >> v;
    for (double& v : pose.q) fields >> v;
    const Eigen::Vector4d q(pose.q.data());
    if (!fields || !to_eigen(pose.p).allFinite() || std::abs(q.norm() - 1) > 0.01) continue;
    poses[frame] = to_eigen(pose);
  }
  if (poses.empty()) return failure(ErrorCode::bad_format, file.string() + " holds no pose");
  return poses;
}

// Paints what is flat: places of B as pixels with four fractional bits.
class Painter {
 public:
  Painter(cv::Mat& picture, const View& view) : picture_(picture), view_(view) {}

  void fill(const std::vector<Eigen::Vector3d>& corners_B, const cv::Scalar& colour) const {
    std::vector<cv::Point> pixels;
    for (const Eigen::Vector3d& p : corners_B) {
      const Eigen::Vector2d at = project(view_, p) * 16;
      pixels.emplace_back(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
    }
    cv::fillConvexPoly(picture_, pixels, colour, cv::LINE_AA, 4);
  }

  void rectangle(double x0, double y0, double x1, double y1, double z, const cv::Scalar& colour) const {
    fill({{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, colour);
  }

  void disc(const Eigen::Vector3d& middle_B, double radius_m, const cv::Scalar& colour) const {
    std::vector<Eigen::Vector3d> rim;
    for (int i = 0; i < 32; ++i) {
      const double a = 2 * EIGEN_PI * i / 32;
      rim.emplace_back(middle_B + radius_m * Eigen::Vector3d(std::cos(a), std::sin(a), 0));
    }
    fill(rim, colour);
  }

 private:
  cv::Mat& picture_;
  const View& view_;
};

cv::Mat painted_room(const View& view, const Scene& scene) {
  cv::Mat picture(view.intrinsics.height, view.intrinsics.width, CV_8UC3);
  for (int y = 0; y < picture.rows; ++y) {
    const double down = static_cast<double>(y) / picture.rows;
    picture.row(y).setTo(cv::Scalar(196 - 70 * down, 200 - 66 * down, 204 - 62 * down));
  }
  const Painter paint(picture, view);
  const BoardGeometry& board = scene.board;
  const double half = board.squares * board.square_size_m / 2;
  const double rim = half + board.border_m;
  paint.rectangle(-0.8, -rim - 0.20, 0.8, rim + 0.20, -board.thickness_m, {86, 112, 140});
  const auto side = [&](double y) {  // the board's edge towards the camera
    paint.fill({{-rim, y, 0}, {rim, y, 0}, {rim, y, -board.thickness_m}, {-rim, y, -board.thickness_m}}, {22, 36, 58});
  };
  side(scene.virtual_side == Side::light ? rim : -rim);
  paint.rectangle(-rim, -rim, rim, rim, 0, {34, 56, 88});
  for (int row = 0; row < board.squares; ++row) {
    for (int col = 0; col < board.squares; ++col) {
      const Point3 c = centre_of_cell_B({row, col}, board);
      const double h = board.square_size_m / 2;
      const bool dark = ((row + col) % 2 == 1) == (board.played_on == SquareColour::dark);
      paint.rectangle(c[0] - h, c[1] - h, c[0] + h, c[1] + h, 0,
                      dark ? cv::Scalar(48, 78, 116) : cv::Scalar(160, 200, 224));
    }
  }
  for (const ScenePiece& piece : scene.pieces) {
    if (!piece.real) continue;
    const Eigen::Vector3d foot = to_eigen(piece.p_B);
    const double height = board.piece_height_m * (piece.king ? 2 : 1);
    const bool dark = piece.side == Side::dark;
    for (int slice = 0; slice < 5; ++slice) {
      paint.disc(foot + Eigen::Vector3d(0, 0, height * slice / 5), board.piece_radius_m,
                 dark ? cv::Scalar(10, 16, 28) : cv::Scalar(70, 120, 160));
    }
    paint.disc(foot + Eigen::Vector3d(0, 0, height), board.piece_radius_m,
               dark ? cv::Scalar(24, 36, 58) : cv::Scalar(110, 170, 210));
  }
  return picture;
}

}  // namespace

Result<Backdrop> Backdrop::from_sequence(const fs::path& folder) {
  Backdrop backdrop;
  const auto camera = read_camera(folder / "camera.json");
  if (!camera) return tl::make_unexpected(camera.error());
  auto poses = read_poses(folder / "poses.csv");
  if (!poses) return tl::make_unexpected(poses.error());
  backdrop.intrinsics_ = *camera;
  backdrop.X_CB_ = std::move(*poses);
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const std::string kind = entry.path().extension().string();
    if (name.rfind("frame_", 0) == 0 && (kind == ".png" || kind == ".jpg")) backdrop.pictures_.push_back(entry.path());
  }
  if (backdrop.pictures_.empty()) {
    return failure(ErrorCode::not_found, folder.string() + " holds no frame_00000.png or .jpg");
  }
  std::sort(backdrop.pictures_.begin(), backdrop.pictures_.end());
  return backdrop;
}

Backdrop Backdrop::plain(int width, int height, const ViewPoint& from) {
  Backdrop backdrop;
  backdrop.from_ = from;
  Intrinsics& k = backdrop.intrinsics_;
  k.width = width;
  k.height = height;
  k.fx = k.fy = from.zoom * height;
  k.cx = (width - 1) / 2.0;
  k.cy = (height - 1) / 2.0;
  return backdrop;
}

Result<BackdropFrame> Backdrop::frame(std::size_t index, const Scene& scene) const {
  BackdropFrame out;
  out.view.intrinsics = intrinsics_;
  if (pictures_.empty()) {
    const double side = scene.virtual_side == Side::light ? 1 : -1;
    const Eigen::Vector3d turned(side, side, 1);
    out.view.X_CB = look_at_X_CB(from_.eye_B.cwiseProduct(turned), from_.look_at_B.cwiseProduct(turned));
    out.bgr = painted_room(out.view, scene);
    return out;
  }
  const std::size_t at = std::min(index, pictures_.size() - 1);
  out.bgr = cv::imread(pictures_[at].string(), cv::IMREAD_COLOR);
  if (out.bgr.cols != intrinsics_.width || out.bgr.rows != intrinsics_.height) {
    return failure(ErrorCode::bad_format, pictures_[at].string() + " is no picture of the size camera.json gives");
  }
  const auto pose = X_CB_.find(at);
  out.seen = pose != X_CB_.end();
  if (out.seen) out.view.X_CB = pose->second;
  return out;
}

}  // namespace counterpart
