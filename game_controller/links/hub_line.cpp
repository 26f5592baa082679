#include "game_controller/links/hub_line.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

namespace counterpart {
namespace {

bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  Result<HubLine> read() {
    HubLine line;
    blanks();
    line.command = word();
    blanks();
    while (at_ < text_.size()) {
      std::string name = word();
      if (name.empty()) return bad("an argument has no name");
      std::string value;
      blanks();
      if (at_ < text_.size() && text_[at_] == '=') {
        ++at_;
        blanks();
        if (at_ < text_.size() && text_[at_] == '"') {
          const auto end = text_.find('"', at_ + 1);
          if (end == std::string_view::npos) return bad("a quoted value does not end");
          value = text_.substr(at_ + 1, end - at_ - 1);
          at_ = end + 1;
        } else {
          value = word();
        }
      }
      line.arguments.emplace_back(std::move(name), std::move(value));
      blanks();
    }
    return line;
  }

 private:
  std::string word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '=' && text_[at_] != '"') ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  void blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }

  tl::unexpected<Error> bad(const std::string& what) const {
    return failure(ErrorCode::bad_format, "column " + std::to_string(at_ + 1) + ": " + what);
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

bool needs_quotes(const std::string& value) {
  return value.empty() || std::any_of(value.begin(), value.end(), [](char c) { return is_blank(c) || c == '='; });
}

}  // namespace

const std::string* HubLine::find(std::string_view name) const {
  for (const auto& [key, value] : arguments) {
    if (key == name) return &value;
  }
  return nullptr;
}

HubLine& HubLine::with(std::string name, std::string value) {
  arguments.emplace_back(std::move(name), std::move(value));
  return *this;
}

Result<HubLine> read_hub_line(std::string_view text) {
  if (text.size() > longest_hub_line) return failure(ErrorCode::limit_exceeded, "a line is longer than 64 KiB");
  return LineReader(text).read();
}

std::string write_hub_line(const HubLine& line) {
  std::string text = line.command;
  for (const auto& [name, value] : line.arguments) {
    std::string clean = value;
    std::erase(clean, '"');
    std::replace_if(
        clean.begin(), clean.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    text += " " + name + "=" + (needs_quotes(clean) ? "\"" + clean + "\"" : clean);
  }
  return text;
}

std::optional<double> hub_number(const std::string& text, double lowest, double highest) {
  if (text.empty() || text.size() > 32) return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size() || !std::isfinite(value) || value < lowest || value > highest)
    return std::nullopt;
  return value;
}

}  // namespace counterpart
