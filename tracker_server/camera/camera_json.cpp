#include "tracker_server/camera/camera_json.hpp"

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

namespace counterpart {

std::string fault_of(const Intrinsics& camera) {
  if (camera.width < 1 || camera.width > 65535 || camera.height < 1 || camera.height > 65535)
    return "width and height must be 1 to 65535 pixels";
  for (double value : {camera.fx, camera.fy, camera.cx, camera.cy})
    if (!std::isfinite(value)) return "fx, fy, cx and cy must be finite numbers";
  if (camera.fx <= 0 || camera.fy <= 0) return "fx and fy must be positive";
  for (double value : camera.dist)
    if (!std::isfinite(value)) return "dist must hold finite numbers";
  return {};
}

Result<Intrinsics> read_camera_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return failure(ErrorCode::not_found, "Cannot open " + path.string() + ".");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  const auto bad = [&](const std::string& why) {
    return failure(
        ErrorCode::bad_format,
        path.string() + ": " + why + "; expected {width, height, fx, fy, cx, cy, dist: [k1, k2, p1, p2, k3]}.");
  };
  if (!json.is_object()) return bad("not a JSON object");

  Intrinsics camera;
  const auto number = [&](const char* name, double& value) {
    const auto field = json.find(name);
    if (field == json.end() || !field->is_number()) return false;
    value = field->get<double>();
    return true;
  };
  double width = 0, height = 0;
  if (!number("width", width) || !number("height", height) || !number("fx", camera.fx) || !number("fy", camera.fy) ||
      !number("cx", camera.cx) || !number("cy", camera.cy))
    return bad("a number is missing");
  if (!(width >= 1 && width <= 65535 && height >= 1 && height <= 65535)) return bad("the size is out of range");
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
  if (const auto dist = json.find("dist"); dist != json.end()) {
    if (!dist->is_array() || dist->size() > camera.dist.size()) return bad("dist must be an array of up to 5 numbers");
    for (std::size_t i = 0; i < dist->size(); ++i) {
      if (!(*dist)[i].is_number()) return bad("dist must hold numbers");
      camera.dist[i] = (*dist)[i].get<double>();
    }
  }
  if (const auto fault = fault_of(camera); !fault.empty()) return bad(fault);
  return camera;
}

Result<void> write_camera_json(const std::filesystem::path& path, const Intrinsics& camera) {
  const nlohmann::ordered_json json = {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
                                       {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy},
                                       {"dist", camera.dist}};
  std::ofstream file(path);
  file << json.dump(2) << '\n';
  if (!file.flush()) return failure(ErrorCode::io, "Cannot write " + path.string() + ".");
  return {};
}

}  // namespace counterpart
