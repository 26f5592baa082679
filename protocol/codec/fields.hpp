// Reads the keys of one JSON object one after the other and remembers the first thing that is wrong.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/codec/names.hpp"
#include "protocol/vocabulary/pose.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

constexpr std::size_t kMaxListEntries = 4096;
constexpr std::size_t kMaxTextBytes = 4096;

struct Range {
  double least = -std::numeric_limits<double>::max();
  double most = std::numeric_limits<double>::max();
};

class Fields {
 public:
  Fields(const nlohmann::json& object, std::string what) : object_(object), what_(std::move(what)) {
    if (!object.is_object()) fail("must be a JSON object", "");
  }

  bool has(const char* key) const { return object_.is_object() && object_.contains(key); }

  template <class T>
  Fields& need(const char* key, T& out, Range range = {}) {
    if (!error_ && !has(key)) fail("is missing", key);
    return maybe(key, out, range);
  }

  template <class T>
  Fields& maybe(const char* key, T& out, Range range = {}) {
    if (!error_ && has(key)) read(object_.at(key), key, out, range);
    return *this;
  }

  // A condition on several keys that cannot be said by a range.
  Fields& require(bool condition, const char* key, const char* problem) {
    if (!error_ && !condition) fail(problem, key);
    return *this;
  }

  // Reads a nested object with `read`, which takes a Fields&.
  template <class Read>
  Fields& object(const char* key, bool needed, Read read) {
    if (error_) return *this;
    if (!has(key)) {
      if (needed) fail("is missing", key);
      return *this;
    }
    Fields inner(object_.at(key), what_ + "." + key);
    read(inner);
    if (inner.error_) error_ = inner.error_;
    return *this;
  }

  template <class T, class Read>
  Fields& objects(const char* key, std::vector<T>& out, Read read) {
    if (error_ || !has(key)) return *this;
    const nlohmann::json& list = object_.at(key);
    if (!is_list(list, key)) return *this;
    for (std::size_t i = 0; i < list.size() && !error_; ++i) {
      Fields inner(list[i], what_ + "." + key + "[" + std::to_string(i) + "]");
      T value{};
      read(inner, value);
      if (inner.error_) error_ = inner.error_;
      out.push_back(std::move(value));
    }
    return *this;
  }

  template <class T>
  Result<T> result(T value) {
    if (error_) return tl::make_unexpected(*error_);
    return value;
  }

  const nlohmann::json& json() const { return object_; }

 private:
  void fail(const std::string& problem, const std::string& key) {
    error_ = Error{ErrorCode::bad_format, what_ + (key.empty() ? "" : "." + key) + " " + problem};
  }

  bool is_list(const nlohmann::json& json, const char* key) {
    if (!json.is_array()) fail("must be a list", key);
    if (!error_ && json.size() > kMaxListEntries) fail("has too many entries", key);
    return !error_;
  }

  void read(const nlohmann::json& json, const char* key, bool& out, Range) {
    if (!json.is_boolean()) return fail("must be true or false", key);
    out = json.get<bool>();
  }

  void read(const nlohmann::json& json, const char* key, std::string& out, Range) {
    if (!json.is_string()) return fail("must be text", key);
    out = json.get<std::string>();
    if (out.size() > kMaxTextBytes) fail("is too long a text", key);
  }

  template <class T>
  requires std::is_floating_point_v<T>
  void read(const nlohmann::json& json, const char* key, T& out, Range range) {
    if (!json.is_number()) return fail("must be a number", key);
    const auto value = json.get<double>();
    if (!std::isfinite(value)) return fail("must be a finite number", key);
    if (value < range.least || value > range.most) return fail("is out of range", key);
    if (std::abs(value) > static_cast<double>(std::numeric_limits<T>::max())) return fail("is out of range", key);
    out = static_cast<T>(value);
  }

  template <class T>
  requires(std::is_integral_v<T> && !std::is_same_v<T, bool>) void read(const nlohmann::json& json, const char* key,
                                                                        T& out, Range range) {
    if (!json.is_number_integer()) return fail("must be a whole number", key);
    if (json.is_number_unsigned()) {
      const auto value = json.get<std::uint64_t>();
      if (!std::in_range<T>(value)) return fail("is out of range", key);
      out = static_cast<T>(value);
    } else {
      const auto value = json.get<std::int64_t>();
      if (!std::in_range<T>(value)) return fail("is out of range", key);
      out = static_cast<T>(value);
    }
    const auto approximate = static_cast<double>(out);
    if (approximate < range.least || approximate > range.most) fail("is out of range", key);
  }

  template <class E>
  requires std::is_enum_v<E>
  void read(const nlohmann::json& json, const char* key, E& out, Range) {
    const auto value = json.is_string() ? from_name<E>(json.get_ref<const std::string&>()) : std::nullopt;
    if (!value) return fail("must be one of " + all_names<E>(), key);
    out = *value;
  }

  template <class T, std::size_t N>
  void read(const nlohmann::json& json, const char* key, std::array<T, N>& out, Range range) {
    if (!json.is_array() || json.size() != N) return fail("must be a list of " + std::to_string(N), key);
    for (std::size_t i = 0; i < N && !error_; ++i) read(json[i], key, out[i], range);
  }

  template <class T>
  void read(const nlohmann::json& json, const char* key, std::vector<T>& out, Range range) {
    if (!is_list(json, key)) return;
    out.clear();
    for (std::size_t i = 0; i < json.size() && !error_; ++i) {
      T value{};
      read(json[i], key, value, range);
      out.push_back(std::move(value));
    }
  }

  const nlohmann::json& object_;
  std::string what_;
  std::optional<Error> error_;
};

}  // namespace counterpart
