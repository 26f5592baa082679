#include "protocol/capture/checkup.hpp"

#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "protocol/capture/session_reader.hpp"
#include "protocol/capture/wire_writer.hpp"
#include "protocol/codec/json.hpp"
#include "protocol/codec/names.hpp"

namespace counterpart {
namespace {

using Way = std::tuple<std::uint32_t, bool, bool>;  // peer, lane, direction

std::string name_of_way(const Way& way) {
  const auto& [peer, video, incoming] = way;
  return std::string(incoming ? "from" : "to") + " peer " + std::to_string(peer) + (video ? ", video lane" : "");
}

struct Watch {
  std::map<Way, std::uint64_t> last_seq;
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::string> open_commands;  // by peer and id
  std::set<std::uint64_t> poses, pictures;
  std::uint64_t dropped = 0;
};

void look_at(const RecordedMessage& recorded, Watch& watch, Checkup& checkup) {
  const Way way{recorded.peer, recorded.video_lane, recorded.incoming};
  if (recorded.seq != 0) {
    std::uint64_t& last = watch.last_seq[way];
    if (recorded.seq > last + 1 && last != 0) {
      checkup.findings.push_back("messages " + std::to_string(last + 1) + " to " + std::to_string(recorded.seq - 1) +
                                 " " + name_of_way(way) + " are missing");
    }
    last = std::max(last, recorded.seq);
  }
  if (const auto* command = std::get_if<Command>(&recorded.message)) {
    watch.open_commands[{recorded.peer, command->id}] = verb_of(command->action);
  }
  if (const auto* feedback = std::get_if<Feedback>(&recorded.message)) {
    if (is_final(feedback->state)) watch.open_commands.erase({recorded.peer, feedback->command_id});
  }
  if (const auto* pose = std::get_if<PoseEstimate>(&recorded.message)) watch.poses.insert(pose->stamp.frame_id);
  if (const auto* video = std::get_if<VideoFrame>(&recorded.message)) watch.pictures.insert(video->stamp.frame_id);
  if (const auto* beat = std::get_if<Heartbeat>(&recorded.message))
    watch.dropped = std::max(watch.dropped, beat->dropped);
}

void conclude(const Watch& watch, Checkup& checkup) {
  std::size_t alone = 0;
  for (const std::uint64_t frame : watch.pictures) alone += watch.poses.count(frame) == 0 ? 1 : 0;
  if (alone > 0 && !watch.poses.empty()) checkup.findings.push_back(std::to_string(alone) + " pictures have no pose");
  for (const auto& [key, verb] : watch.open_commands) {
    checkup.findings.push_back("command " + std::to_string(key.second) + " (" + verb + ") has no final answer");
  }
  if (watch.dropped > 0) {
    checkup.findings.push_back(std::to_string(watch.dropped) + " messages were pushed out by newer ones on the way");
  }
}

// What was said, as text that two runs share: stamps and ids of sessions are not in it.
std::string said(const RecordedMessage& recorded) {
  nlohmann::json body = to_json(recorded.message);
  for (const char* key : {"capture_ns", "stamp_ns"}) body.erase(key);
  return std::string(recorded.incoming ? "in " : "out ") + std::string(name_of(type_of(recorded.message))) + " " +
         body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<std::vector<std::string>> all_said(const std::string& path) {
  auto reader = SessionReader::open(path);
  if (!reader) return tl::make_unexpected(reader.error());
  std::vector<std::string> lines;
  while (const auto recorded = (*reader)->next()) {
    if (is_about_the_game(type_of(recorded->message))) lines.push_back(said(*recorded));
  }
  if ((*reader)->problem()) return tl::make_unexpected(*(*reader)->problem());
  return lines;
}

}  // namespace

Result<Checkup> check_capture(const std::string& path) {
  auto reader = SessionReader::open(path);
  if (!reader) return tl::make_unexpected(reader.error());
  Checkup checkup;
  Watch watch;
  while (const auto recorded = (*reader)->next()) {
    ++checkup.messages;
    look_at(*recorded, watch, checkup);
  }
  conclude(watch, checkup);
  if ((*reader)->problem()) checkup.damage.push_back((*reader)->problem()->message);
  if ((*reader)->passed_over() > 0) {
    checkup.findings.push_back(std::to_string((*reader)->passed_over()) + " messages are damaged or of unknown type");
  }
  return checkup;
}

Result<Recovery> recover_capture(const std::string& damaged, const std::string& recovered) {
  auto reader = McapReader::open(damaged);
  if (!reader) return tl::make_unexpected(reader.error());
  auto writer = McapWriter::create(recovered);
  if (!writer) return tl::make_unexpected(writer.error());
  Recovery recovery;
  bool noted = false;
  const auto note = [&]() -> Result<void> {
    noted = true;
    for (const auto& [name, values] : (*reader)->metadata()) {
      if (auto done = (*writer)->write_metadata(name, values); !done) return done;
    }
    return {};
  };
  while (const auto message = (*reader)->next()) {
    if (!noted) {
      if (auto done = note(); !done) return tl::make_unexpected(done.error());
    }
    if (message->topic != "/wire") continue;
    const bool good = add_wire_record(**writer, message->data, static_cast<std::int64_t>(message->log_ns));
    ++(good ? recovery.messages : recovery.passed_over);
    if ((*writer)->chunk_bytes() < (1U << 20)) continue;
    if (auto done = (*writer)->write_chunk(); !done) return tl::make_unexpected(done.error());
  }
  if (auto done = (*writer)->close(); !done) return tl::make_unexpected(done.error());
  if ((*reader)->problem()) recovery.problem = (*reader)->problem()->message;
  auto proof = SessionReader::open(recovered);
  if (!proof) return tl::make_unexpected(proof.error());
  std::uint64_t found = 0;
  while ((*proof)->next()) ++found;
  found += (*proof)->passed_over();  // of types that this version does not know
  if (found != recovery.messages || (*proof)->problem()) {
    return failure(ErrorCode::internal, recovered + " does not read back: " + std::to_string(found) + " of " +
                                            std::to_string(recovery.messages) + " messages");
  }
  return recovery;
}

Result<std::vector<std::string>> compare_captures(const std::string& a, const std::string& b, std::size_t most) {
  const auto left = all_said(a), right = all_said(b);
  if (!left) return tl::make_unexpected(left.error());
  if (!right) return tl::make_unexpected(right.error());
  std::vector<std::string> differences;
  for (std::size_t i = 0; i < std::max(left->size(), right->size()) && differences.size() < most; ++i) {
    if (i >= left->size() || i >= right->size()) {
      differences.push_back((i >= left->size() ? a : b) + " ends after " + std::to_string(i) +
                            " messages, the other has " + std::to_string(std::max(left->size(), right->size())));
      break;
    }
    if ((*left)[i] == (*right)[i]) continue;
    differences.push_back("message " + std::to_string(i + 1) + ":\n  - " + (*left)[i] + "\n  + " + (*right)[i]);
  }
  return differences;
}

}  // namespace counterpart
