#include "protocol/vhp/script.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "protocol/codec/names.hpp"

namespace counterpart::vhp {
namespace {

constexpr std::size_t kMostLines = 10'000;
constexpr int kMostTimes = 1'000'000;
constexpr int kDeepest = 16;

using Words = std::vector<std::string>;

Words words_of(const std::string& line) {
  std::istringstream in(line);
  Words words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

Words split(const std::string& list) {
  std::istringstream in(list);
  Words parts;
  for (std::string part; std::getline(in, part, ',');) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

bool is_label(const std::string& text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), plain);
}

bool read_number(const std::string& text, double& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(out) && out >= 0 && out <= 86'400;
}

class Parser {
 public:
  Parser(const std::string& text, std::string name) : in_(text), name_(std::move(name)) {}

  Result<std::vector<Statement>> parse() { return block(0); }

 private:
  tl::unexpected<Error> bad(const std::string& problem) const {
    return failure(ErrorCode::bad_format, name_ + ":" + std::to_string(line_) + ": " + problem);
  }

  // Statements up to "end", or up to the end of the text.
  Result<std::vector<Statement>> block(int depth) {
    std::vector<Statement> statements;
    const int opened = line_;
    if (depth > kDeepest) return bad("too many loops inside each other");
    for (std::string line; std::getline(in_, line);) {
      if (static_cast<std::size_t>(++line_) > kMostLines) return bad("too many lines");
      const Words words = words_of(line);
      if (words.empty() || words[0][0] == '#') continue;
      if (words[0] == "end") {
        if (depth == 0) return bad("\"end\" without \"repeat\"");
        return statements;
      }
      auto statement = one(line, words, depth);
      if (!statement) return tl::make_unexpected(statement.error());
      statements.push_back(std::move(*statement));
    }
    if (depth > 0) return bad("the \"repeat\" of line " + std::to_string(opened) + " has no \"end\"");
    return statements;
  }

  Result<Statement> one(const std::string& line, const Words& words, int depth) {
    Statement statement;
    statement.line = line_;
    statement.text = line.substr(line.find_first_not_of(" \t\r"));
    while (!statement.text.empty() && std::isspace(static_cast<unsigned char>(statement.text.back())) != 0) {
      statement.text.pop_back();
    }
    if (words[0] == "repeat") return repeat(std::move(statement), words, depth);
    if (words[0] == "sleep") return sleep(std::move(statement), words);
    if (words[0] == "wait") return wait(std::move(statement), words);
    if (words[0] == "expect") return expect(std::move(statement), words);
    if (words[0] == "print") {
      statement.kind = StatementKind::print;
      statement.text = statement.text.size() > 6 ? statement.text.substr(6) : "";
      return statement;
    }
    return request(std::move(statement));
  }

  Result<Statement> repeat(Statement statement, const Words& words, int depth) {
    statement.kind = StatementKind::repeat;
    double times = 0;
    if (words.size() != 2 || !read_number(words[1], times) || times < 1 || times > kMostTimes ||
        times != std::floor(times)) {
      return bad("write \"repeat N\"");
    }
    statement.times = static_cast<int>(times);
    auto body = block(depth + 1);
    if (!body) return tl::make_unexpected(body.error());
    statement.body = std::move(*body);
    return statement;
  }

  Result<Statement> sleep(Statement statement, const Words& words) {
    statement.kind = StatementKind::sleep;
    if (words.size() != 2 || !read_number(words[1], statement.seconds)) return bad("write \"sleep SECONDS\"");
    return statement;
  }

  // Takes "within S" off the end.
  bool take_limit(Words& words, Statement& statement) const {
    const auto within = std::find(words.begin(), words.end(), "within");
    if (within == words.end()) return true;
    if (words.end() - within != 2 || !read_number(words.back(), statement.seconds)) return false;
    words.erase(within, words.end());
    return true;
  }

  Result<Statement> wait(Statement statement, Words words) {
    statement.kind = StatementKind::wait;
    statement.seconds = 60;
    if (!take_limit(words, statement)) return bad("write \"wait [NAME ...] [within SECONDS]\"");
    statement.labels.assign(words.begin() + 1, words.end());
    for (const std::string& label : statement.labels) {
      if (labels_.count(label) == 0) return bad("no command before this line is called " + label);
    }
    return statement;
  }

  Result<Statement> expect(Statement statement, Words words) {
    if (!take_limit(words, statement) || words.size() < 3) {
      return bad(
          "write \"expect NAME finished|failed|cancelled [CODE]\", \"expect event KIND [code=C] [move=M]\" or "
          "\"expect phase PHASE\", each with [within SECONDS]");
    }
    if (words[1] == "event") return expect_event(std::move(statement), words);
    if (words[1] == "phase") {
      statement.kind = StatementKind::expect_phase;
      const auto phase = from_name<GamePhase>(words[2]);
      if (!phase || words.size() > 3) return bad("the phase must be one of " + all_names<GamePhase>());
      statement.phase = *phase;
      return statement;
    }
    statement.kind = StatementKind::expect_command;
    statement.labels = {words[1]};
    if (labels_.count(words[1]) == 0) return bad("no command before this line is called " + words[1]);
    const auto state = from_name<FeedbackState>(words[2]);
    if (!state || !is_final(*state) || words.size() > 4) return bad("a command ends finished, failed or cancelled");
    statement.state = *state;
    if (words.size() == 4) statement.code = words[3];
    return statement;
  }

  Result<Statement> expect_event(Statement statement, const Words& words) {
    statement.kind = StatementKind::expect_event;
    const auto kind = from_name<EventKind>(words[2]);
    if (!kind) return bad("the event must be one of " + all_names<EventKind>());
    statement.event = *kind;
    for (std::size_t i = 3; i < words.size(); ++i) {
      if (words[i].rfind("code=", 0) == 0) {
        statement.code = words[i].substr(5);
      } else if (words[i].rfind("move=", 0) == 0) {
        statement.move = words[i].substr(5);
      } else {
        return bad("an event is described by code=C and move=M, not by \"" + words[i] + "\"");
      }
    }
    return statement;
  }

  // [NAME:] [after A,B] VERB ...
  Result<Statement> request(Statement statement) {
    statement.kind = StatementKind::request;
    std::string rest = statement.text;
    const std::string first = rest.substr(0, rest.find_first_of(" \t"));
    if (first.size() > 1 && first.back() == ':') {
      statement.label = first.substr(0, first.size() - 1);
      if (!is_label(statement.label)) return bad("a name is made of letters, digits, - and _");
      rest = rest.substr(std::min(rest.size(), first.size() + 1));
    }
    const Words words = words_of(rest);
    if (!words.empty() && words[0] == "after") {
      if (words.size() < 3) return bad("write \"after NAME,NAME VERB ...\"");
      statement.labels = split(words[1]);
      for (const std::string& label : statement.labels) {
        if (labels_.count(label) == 0) return bad("no command before this line is called " + label);
      }
      rest = rest.substr(rest.find(words[1], rest.find("after") + 5) + words[1].size());
    }
    auto request = read_request(rest, BoardGeometry{});
    if (!request) return bad(request.error().message);
    statement.request = std::move(*request);
    if (!statement.label.empty()) labels_.insert(statement.label);
    return statement;
  }

  std::istringstream in_;
  std::string name_;
  int line_ = 0;
  std::set<std::string> labels_;
};

}  // namespace

Result<std::vector<Statement>> parse_script(const std::string& text, const std::string& name) {
  return Parser(text, name).parse();
}

}  // namespace counterpart::vhp
