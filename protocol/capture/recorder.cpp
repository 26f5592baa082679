#include "protocol/capture/recorder.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "protocol/capture/mcap_writer.hpp"
#include "protocol/capture/wire_writer.hpp"
#include "protocol/codec/names.hpp"

namespace counterpart {
namespace {

constexpr auto kChunkTime = std::chrono::milliseconds(200);
constexpr std::size_t kChunkBytes = 1U << 20;
constexpr std::size_t kMostPendingBytes = 256U << 20;
constexpr std::size_t kMemoryKept = 32U << 20;  // for what comes next

}  // namespace

struct Recorder::State {
  struct Seen {
    std::int64_t now_ns = 0;
    std::size_t end = 0;  // of its record
  };

  // Records one behind the other: the thread that sends a message only copies it.
  struct Batch {
    Bytes records;  // WireRecords
    std::vector<Seen> seen;

    void clear() {
      records.clear();
      seen.clear();
      if (records.capacity() > kMemoryKept) records = {};
    }
  };

  std::unique_ptr<McapWriter> writer;  // these two are the writing thread's alone
  Batch batch;
  std::mutex mutex;
  std::condition_variable changed;
  Batch pending;
  std::uint64_t lost = 0;
  bool ending = false;
  std::optional<Error> error;
  bool error_taken = false;
  std::thread thread;

  void note(const Error& why) {
    const std::lock_guard lock(mutex);
    if (!error) error = why;
  }

  // Takes everything that waits, as chunks; true: the end was asked for.
  bool write_pending() {
    bool end = false;
    {
      std::unique_lock lock(mutex);
      changed.wait_for(lock, kChunkTime, [&] { return ending || pending.records.size() >= kChunkBytes; });
      std::swap(batch, pending);
      end = ending;
    }
    const ByteView records(batch.records);
    std::size_t begin = 0;
    for (const Seen& seen : batch.seen) {
      add_wire_record(*writer, records.subspan(begin, seen.end - begin), seen.now_ns);
      begin = seen.end;
      if (writer->chunk_bytes() >= kChunkBytes) flush();
    }
    flush();
    batch.clear();
    return end;
  }

  void flush() {
    if (auto done = writer->write_chunk(); !done) note(done.error());
  }

  void run() {
    while (!write_pending()) {
    }
    if (auto done = writer->close(); !done) note(done.error());
  }
};

Recorder::Recorder(std::unique_ptr<State> state) : state_(std::move(state)) {
  state_->thread = std::thread([this] { state_->run(); });
}

Result<std::unique_ptr<Recorder>> Recorder::open(const std::string& path, Role role, const std::string& software) {
  auto writer = McapWriter::create(path);
  if (!writer) return tl::make_unexpected(writer.error());
  const auto utc =
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
  auto noted = (*writer)->write_metadata(
      "session",
      {{"role", std::string(name_of(role))}, {"software", software}, {"started_utc_ns", std::to_string(utc)}});
  if (!noted) return tl::make_unexpected(noted.error());
  auto state = std::make_unique<State>();
  state->writer = std::move(*writer);
  return std::unique_ptr<Recorder>(new Recorder(std::move(state)));
}

Recorder::~Recorder() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->ending = true;
  }
  state_->changed.notify_one();
  state_->thread.join();
}

void Recorder::saw(bool incoming, bool video_lane, PeerId peer, const HeaderBytes& header, ByteView body,
                   std::int64_t now_ns) {
  bool full = false;
  {
    const std::lock_guard lock(state_->mutex);
    State::Batch& pending = state_->pending;
    const bool was_full = pending.records.size() >= kChunkBytes;
    if (pending.records.size() > kMostPendingBytes) {
      ++state_->lost;
      if (!state_->error) {
        state_->error =
            Error{ErrorCode::limit_exceeded, "the disk is too slow for the capture: messages are missing in it"};
      }
      return;
    }
    append_wire_record(pending.records, incoming, video_lane, peer, header, body);
    pending.seen.push_back({now_ns, pending.records.size()});
    full = !was_full && pending.records.size() >= kChunkBytes;
  }
  if (full) state_->changed.notify_one();
}

std::optional<Error> Recorder::take_error() {
  const std::lock_guard lock(state_->mutex);
  if (!state_->error || state_->error_taken) return std::nullopt;
  state_->error_taken = true;
  return state_->error;
}

}  // namespace counterpart
