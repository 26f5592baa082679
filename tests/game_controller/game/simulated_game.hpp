// A whole game without camera and screen: a real player who answers with legal moves through synthetic readings, with
// frames in which his hand covers the board; a renderer that answers commands; an engine that picks moves by seed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "game_controller/engine/opponent.hpp"
#include "game_controller/game/game.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/routes.hpp"

namespace counterpart::simulated {

constexpr std::int64_t frame_ns = 40'000'000;

inline std::uint64_t next_random(std::uint64_t& state) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return state >> 33;
}

// The real pieces that stand on the board, and what a camera would say of them.
struct Table {
  int n = 10;
  Side side = Side::dark;
  Bits pieces = 0;
  std::optional<Bits> light;  // where both sides' pieces are real: those of them that are light
  std::vector<Cell> strays;

  Occupancy seen(std::int64_t frame, bool hand) const {
    Occupancy occupancy;
    occupancy.stamp = {static_cast<FrameId>(frame), frame * frame_ns};
    occupancy.squares = n;
    occupancy.covered = hand;
    occupancy.cells.resize(static_cast<std::size_t>(n * n));
    for (int row = 0; row < n; ++row) {
      for (int col = 0; col < n; ++col) {
        CellSight& cell = occupancy.cells[static_cast<std::size_t>(row * n + col)];
        const auto square = square_of_cell({row, col}, n);
        cell.reading = CellReading::empty;
        if (square && (pieces & square_mask(*square, n)) != 0) {
          const bool is_dark = light ? (*light & square_mask(*square, n)) == 0 : side == Side::dark;
          cell.reading = is_dark ? CellReading::dark : CellReading::light;
        }
        if (hand && col >= 2 && col <= 5) cell.reading = CellReading::unknown;
      }
    }
    for (const Cell& stray : strays) {
      occupancy.cells[static_cast<std::size_t>(stray.row * n + stray.col)].reading = CellReading::piece;
    }
    return occupancy;
  }
};

// Does what it is told, a few frames later; knows where the virtual pieces stand from scenes and grasps alone.
struct Renderer {
  std::map<std::string, Point3> pieces;
  std::map<std::uint64_t, std::pair<Command, int>> running;  // and the frames it still takes
  std::vector<std::string> verbs;                            // what was told, in order
  int kings = 0;                                             // in the last scene
  std::uint64_t last_id = 0;
  bool ids_grow = true;
  int fail_grasps = 0;  // so many of the next grasps fail

  void receive(const GameOutputs& out) {
    if (out.scene) {
      pieces.clear();
      kings = 0;
      for (const ScenePiece& piece : out.scene->pieces) {
        kings += !piece.real && piece.king ? 1 : 0;
        if (!piece.real) pieces[piece.name] = piece.p_B;
      }
    }
    for (const Command& command : out.commands) {
      ids_grow = ids_grow && command.id > last_id;
      last_id = command.id;
      verbs.push_back(std::to_string(command.action.index()));
      running[command.id] = {command, 5};
    }
  }

  std::vector<Feedback> frame(std::int64_t now_ns) {
    std::vector<Feedback> feedback;
    std::vector<std::uint64_t> ended;
    for (auto& [id, entry] : running) {
      bool waits = false;
      for (const std::uint64_t before : entry.first.after) waits = waits || running.count(before) > 0;
      if (waits || --entry.second > 0) continue;
      FeedbackState state = FeedbackState::finished;
      if (const auto* grasp = std::get_if<Grasp>(&entry.first.action); grasp != nullptr && !grasp->piece.empty()) {
        if (fail_grasps > 0) {
          --fail_grasps;
          state = FeedbackState::failed;
        } else if (pieces.count(grasp->piece) == 0) {
          state = FeedbackState::failed;
        } else {
          pieces[grasp->piece] = grasp->path_B.back();
        }
      }
      Feedback answer;
      answer.command_id = id;
      answer.state = state;
      answer.stamp_ns = now_ns;
      feedback.push_back(answer);
      ended.push_back(id);
    }
    for (const std::uint64_t id : ended) running.erase(id);
    return feedback;
  }

  // A hand is about to take it off the board.
  bool is_leaving(const std::string& name, const BoardGeometry& board) const {
    return std::any_of(running.begin(), running.end(), [&](const auto& entry) {
      const auto* grasp = std::get_if<Grasp>(&entry.second.first.action);
      return grasp != nullptr && grasp->piece == name && !cell_at_B(grasp->path_B.back(), board);
    });
  }

  // Squares of the virtual pieces, by what is drawn; without those that have been captured and are still to be taken
  // off.
  Bits drawn(const BoardGeometry& board) const {
    Bits bits = 0;
    for (const auto& [name, p_B] : pieces) {
      if (is_leaving(name, board)) continue;
      const auto cell = cell_at_B(p_B, board);
      const auto square = cell ? square_of_cell(*cell, board.squares) : std::nullopt;
      if (square) bits |= square_mask(*square, board.squares);
    }
    return bits;
  }
};

// Everything together. Runs frame by frame; the real player acts by himself when it is his turn, unless told not to.
struct Play {
  GameOptions options;
  Game game;
  Table table;
  Renderer renderer;
  std::uint64_t random;
  std::int64_t frame = 0;
  bool player_acts = true;
  bool player_removes = true;
  bool player_does_favours = true;  // where all pieces are real: makes the virtual player's moves for him
  int hand_frames = 0;              // the hand covers the board for so long
  Bits after_hand = 0;              // and then the pieces stand so
  Bits light_after_hand = 0;
  bool hand_is_over = false;
  int rest_frames = 0;
  std::vector<GameEvent> events;
  std::vector<std::string> log;  // every event as text
  std::vector<Control> controls;
  bool join = true;
  std::optional<std::string> thinking_about;
  int thinking_frames = 0;
  std::int64_t moves_drawn_right = 0;

  Play(const GameOptions& o, std::uint64_t seed) : options(o), game(std::move(*Game::start(o))), random(seed) {
    table.n = rules().squares;
    table.side = other(o.virtual_side);
    table.pieces = pieces_of(position(), table.side);
    if (o.both_real) {
      table.pieces = position().light | position().dark;
      table.light = position().light;
    }
  }

  const Rules& rules() const { return *find_rules(options.rules); }
  Position position() const { return *read_squares(rules(), game.board_state().squares, game.board_state().turn); }

  void put(Bits pieces, int frames_of_hand = 6) {
    after_hand = pieces;
    hand_frames = frames_of_hand;
    hand_is_over = true;
  }

  // All pieces, of both sides.
  void put(const Position& p) {
    light_after_hand = p.light;
    put(p.light | p.dark);
  }

  void player() {
    if (hand_is_over) {
      if (--hand_frames <= 0) {
        hand_is_over = false;
        table.pieces = after_hand;
        if (table.light) table.light = light_after_hand;
        rest_frames = 15;
      }
      return;
    }
    if (rest_frames-- > 0) return;
    const BoardState& state = game.board_state();
    if (state.phase == GamePhase::waiting_for_removal && player_removes) {
      put(table.pieces & ~bits_of_squares(state.to_remove, table.n));
    } else if (state.phase == GamePhase::real_to_move && player_acts) {
      const Position p = position();
      MoveList legal;
      generate(rules(), p, legal);
      const Move& move = legal[static_cast<int>(next_random(random) % static_cast<std::uint64_t>(legal.size()))];
      if (options.both_real) return put(after(rules(), p, move));
      if (move.from == move.to) return;
      put((pieces_of(p, table.side) & ~one(move.from)) | one(move.to));
    }
  }

  GameOutputs step() {
    GameInputs in;
    in.now_ns = frame * frame_ns;
    in.sight = table.seen(frame, hand_is_over);
    in.feedback = renderer.frame(in.now_ns);
    in.controls = std::exchange(controls, {});
    in.renderer_joined = std::exchange(join, false);
    if (thinking_about && --thinking_frames <= 0) {
      const Position p = *read_fen(rules(), *thinking_about);
      MoveList legal;
      generate(rules(), p, legal);
      const Move& move = legal[static_cast<int>(next_random(random) % static_cast<std::uint64_t>(legal.size()))];
      in.engine_move = path_text(rules(), p, move);
      thinking_about.reset();
    }
    GameOutputs out = game.step(in);
    renderer.receive(out);
    if (out.think) {
      thinking_about = out.think;
      thinking_frames = 3;
    }
    for (const GameEvent& e : out.events) {
      events.push_back(e);
      std::string text =
          std::to_string(frame) + " " + std::to_string(static_cast<int>(e.kind)) + " " + e.code + " " + e.move;
      for (const int square : e.squares) text += " " + std::to_string(square);
      log.push_back(text);
      if (e.code == "make_it_for_me" && player_does_favours) {
        put(after(rules(), position(), *read_move(rules(), position(), e.move)));
      }
      if (e.kind == EventKind::turn && renderer.drawn(options.board) == pieces_of(position(), options.virtual_side)) {
        ++moves_drawn_right;
      }
    }
    ++frame;
    player();
    return out;
  }

  // Steps until there is such an event; false after so many frames without.
  bool until(EventKind kind, int frames = 1500) {
    for (int i = 0; i < frames; ++i) {
      for (const GameEvent& e : step().events) {
        if (e.kind == kind) return true;
      }
    }
    return false;
  }

  int count(EventKind kind) const {
    int n = 0;
    for (const GameEvent& e : events) n += e.kind == kind ? 1 : 0;
    return n;
  }
};

}  // namespace counterpart::simulated
