#include "stage/scenario/located_json.hpp"

#include <iterator>
#include <vector>

namespace counterpart::stage {
namespace {

using nlohmann::json;

// Counts the lines that the parser has read.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, int* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    if (*at_ == '\n' && line_ != nullptr) ++*line_;
    ++at_;
    return *this;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  int* line_;
};

// Follows the parser and notes the line of every key and array element.
class LineNotes : public nlohmann::json_sax<json> {
 public:
  LineNotes(const int& line, std::map<std::string, int>& line_of) : line_(line), line_of_(line_of) {}

  bool null() override { return note(); }
  bool boolean(bool) override { return note(); }
  bool number_integer(number_integer_t) override { return note(); }
  bool number_unsigned(number_unsigned_t) override { return note(); }
  bool number_float(number_float_t, const string_t&) override { return note(); }
  bool string(string_t&) override { return note(); }
  bool binary(binary_t&) override { return note(); }
  bool start_object(std::size_t) override {
    mark();
    levels_.push_back({false, 0, ""});
    return true;
  }
  bool key(string_t& name) override {
    levels_.back().key = name;
    line_of_[path()] = line_;
    return true;
  }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override {
    mark();
    levels_.push_back({true, 0, ""});
    return true;
  }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    message = error.what();
    error_line = line_;
    return false;
  }

  std::string message;
  int error_line = 0;

 private:
  struct Level {
    bool array;
    std::size_t index;
    std::string key;
  };

  std::string path() const {
    std::string result;
    for (const Level& level : levels_) result += "/" + (level.array ? std::to_string(level.index) : level.key);
    return result;
  }
  void mark() {
    if (!levels_.empty() && levels_.back().array) line_of_[path()] = line_;
  }
  bool next() {
    if (!levels_.empty() && levels_.back().array) ++levels_.back().index;
    return true;
  }
  bool note() {
    mark();
    return next();
  }
  bool leave() {
    levels_.pop_back();
    return next();
  }

  const int& line_;
  std::map<std::string, int>& line_of_;
  std::vector<Level> levels_;
};

}  // namespace

Result<LocatedJson> parse_located(const std::string& text) {
  LocatedJson result;
  int line = 1;
  LineNotes notes(line, result.line_of);
  const char* first = text.data();
  if (!json::sax_parse(CountingIterator(first, &line), CountingIterator(first + text.size(), nullptr), &notes)) {
    return failure(ErrorCode::bad_format, "line " + std::to_string(notes.error_line) + ": not JSON: " + notes.message);
  }
  result.value = json::parse(text);
  return result;
}

}  // namespace counterpart::stage
