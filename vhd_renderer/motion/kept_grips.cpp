#include "vhd_renderer/motion/kept_grips.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace counterpart {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3f;
using nlohmann::json;

// Part of the file's name: another way of fitting makes another file.
constexpr int fit_version = 1;
constexpr std::uintmax_t largest_file = 1U << 16U;

class Fingerprint {
 public:
  void add(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int k = 0; k < 4; ++k) hash_ = (hash_ ^ ((bits >> (8 * k)) & 255U)) * 1099511628211ULL;  // FNV-1a
  }
  void add(const Vector3f& p) {
    for (const float one : p) add(one);
  }
  std::string text() const {
    std::ostringstream out;
    out << std::hex << hash_;
    return out.str();
  }

 private:
  std::uint64_t hash_ = 1469598103934665603ULL;
};

// All that a fit depends on: the hand's skin and bones as they bend, and the pieces.
std::string fingerprint_of(const Figure& figure, const HandParts& hand, const GripTarget& target) {
  Fingerprint print;
  for (const float one : {target.radius_m, target.height_m, target.square_m, hand.thumb_side}) print.add(one);
  const HandSkin skin(figure, hand);
  for (const char* shape : {"flat", "fist"}) {
    for (const auto& part : skin.places_W(hand_shape(shape))) {
      for (const Vector3f& p : part) print.add(p);
    }
    for (std::size_t f = 0; f < hand.fingers.size(); ++f) {
      const Fingertip tip = fingertip_W(figure, hand, hand_shape(shape), f);
      print.add(tip.pad);
      print.add(tip.pad_normal);
      print.add(tip.tip);
    }
  }
  return print.text();
}

// The numbers of a grip, one after the other; `visit` may read or write them.
template <class AnyGrip, class Visit>
void each_number(AnyGrip& grip, Visit visit) {
  for (auto* shape : {&grip.open, &grip.closed}) {
    for (auto& finger : shape->fingers) {
      for (auto& flex : finger.flex_rad) visit(flex);
      visit(finger.spread_rad);
    }
    for (Eigen::Index i = 0; i < 3; ++i) visit(shape->thumb_turn_W[i]);
  }
  for (Eigen::Index c = 0; c < 4; ++c) {
    for (Eigen::Index r = 0; r < 3; ++r) visit(grip.X_WP.matrix()(r, c));
  }
  visit(grip.residual_mm);
}

bool is_sound(const Grip& grip) {
  const Eigen::Matrix3f R = grip.X_WP.linear();
  const bool turn = (R * R.transpose()).isIdentity(1e-3F) && R.determinant() > 0;
  return turn && grip.X_WP.translation().norm() < 1;
}

std::optional<Grip> read_grip(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > largest_file) return std::nullopt;
  std::ifstream in(file);
  const json numbers = json::parse(in, nullptr, false);
  if (!numbers.is_array()) return std::nullopt;
  Grip grip;
  std::size_t next = 0;
  bool whole = true;
  each_number(grip, [&](float& number) {
    whole = whole && next < numbers.size() && numbers[next].is_number();
    if (whole) number = numbers[next++].get<float>();
    whole = whole && std::isfinite(number) && std::abs(number) < 10;
  });
  if (!whole || next != numbers.size() || !is_sound(grip)) return std::nullopt;
  return grip;
}

// Under another name first, so that nobody reads half a file.
void write_grip(const Grip& grip, const fs::path& file) {
  json numbers = json::array();
  each_number(grip, [&](const float& number) { numbers.push_back(number); });
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  const fs::path draft = file.string() + "." + std::to_string(::getpid());
  std::ofstream out(draft);
  out << numbers.dump() << '\n';
  out.close();
  if (out) fs::rename(draft, file, error);
  if (!out || error) fs::remove(draft, error);
}

}  // namespace

GripSource grips_kept_in(const fs::path& folder) {
  return [folder](const Figure& figure, const HandParts& hand, const GripTarget& target) {
    const fs::path file =
        folder / ("grip-" + std::to_string(fit_version) + "-" + fingerprint_of(figure, hand, target) + ".json");
    if (auto kept = read_grip(file)) {
      kept->open_skin_P = open_skin_P(figure, hand, *kept);
      return *kept;
    }
    Grip grip = grip_on_piece(figure, hand, target);
    write_grip(grip, file);
    return grip;
  };
}

}  // namespace counterpart
