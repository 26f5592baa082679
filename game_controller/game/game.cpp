#include "game_controller/game/game.hpp"

#include <utility>

#include "game_controller/engine/opponent.hpp"
#include "game_controller/game/state.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/notation/pdn_write.hpp"
#include "game_controller/referee/sentences.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr std::int64_t hand_patience_ns =
    45'000'000'000;  // no word of a grasp for so long: the piece is set without it

bool is_crowned(const Rules& rules, const Position& before, const Move& move) {
  return (before.kings & one(move.from)) == 0 && (after(rules, before, move).kings & one(move.to)) != 0;
}

const char* side_name(Side side) {
  return side == Side::light ? "light" : "dark";
}

}  // namespace

Game::State::State(const GameOptions& o, const Rules& r, const Position& start, std::uint64_t first_command)
    : options(o),
      rules(&r),
      record(r, start),
      lost(o.board, o.virtual_side),
      human(o.board, first_command),
      eyes(o.both_real ? Asked::colours : Asked::places) {
  name_pieces();
}

void Game::State::step(const GameInputs& inputs) {
  now_ns = inputs.now_ns;
  out = {};
  if (inputs.renderer_joined) renderer_joined();
  for (const Control& control : inputs.controls) obey(control);
  for (const Feedback& feedback : inputs.feedback) hear(feedback);
  if (inputs.engine_move) receive_engine_move(*inputs.engine_move);
  if (inputs.sight) {
    eyes.see(*inputs.sight, rules->squares, now_ns);
    look();
  }
  if (pending && pending->told_ns < 0) pending->told_ns = now_ns;  // resumed: its patience begins now
  const bool by_his_hand = !options.both_real;
  if (pending && by_his_hand && pending->grasp != 0 && now_ns - pending->told_ns > hand_patience_ns) landed();
  if (lost.under_way() && now_ns - lost_told_ns > hand_patience_ns) set_lost_down();
  if (pending && pending->grasp == 0 && phase == GamePhase::virtual_to_move && !lost.under_way()) tell_move();
  if (ask_engine && phase == GamePhase::virtual_to_move) {
    ask_engine = false;
    thinking = true;
    out.think = write_fen(*rules, record.position());
    human.think();
  }
  out.commands = human.take();
  BoardState state = board_state();
  state.revision = shown.revision;
  if (!(state == shown) || !given_out) {
    given_out = true;
    state.revision = ++revision;
    shown = state;
    out.board_state = std::move(state);
  }
}

void Game::State::begin() {
  if (!started) {
    started = true;
    event(EventKind::game_started).side = record.position().turn;
    const char* code = real_to_move() ? "you_begin" : "begin";
    human.say(code, sentence(code, {}));
  } else {
    event(EventKind::board_restored).side = real_side();
  }
  hand_over();
}

// The position is settled: who is to move now, or is it over?
void Game::State::hand_over() {
  announced.reset();
  stops.clear();
  pending.reset();
  if (const auto ending = record.ending()) {
    finish(*ending);
    return;
  }
  event(EventKind::turn).side = record.position().turn;
  if (real_to_move()) {
    phase = GamePhase::real_to_move;
    human.watch_board();
  } else {
    phase = GamePhase::virtual_to_move;
    ask_engine = true;
  }
}

void Game::State::commit(const Move& move) {
  const Position before = record.position();
  const Side mover = before.turn;
  const auto ways = routes(*rules, before, move);
  const Route& route = ways.front();
  const bool crowned = is_crowned(*rules, before, move);
  GameEvent& moved = event(EventKind::move);
  moved.side = mover;
  moved.move = pdn_text(*rules, before, move);
  moved.squares = route.squares;
  moved.captured = route.captured;
  if (move.captured != 0) {
    GameEvent& captured = event(EventKind::captured);
    captured.side = other(mover);
    captured.captured = route.captured;
  }
  if (crowned) {
    GameEvent& promoted = event(EventKind::promoted);
    promoted.side = mover;
    promoted.squares = {route.squares.back()};
    if (mover == real_side()) human.say("crowned", sentence("crowned", promoted.squares));
  }
  explain_surprise(before, move, route);
  move_names(before, move, route);
  carry_lost();
  record.play(move);
  announced.reset();
}

void Game::State::finish(const Ending& ending) {
  phase = GamePhase::over;
  result = ending.result;
  result_code = ending.code;
  pending.reset();
  thinking = ask_engine = false;
  GameEvent& over = event(EventKind::game_over);
  over.result = ending.result;
  over.code = ending.code;
  const bool drawn = ending.result == GameResult::draw;
  const bool light_won = ending.result == GameResult::light_wins;
  const bool won = !drawn && light_won == (options.virtual_side == Side::light);
  const char* code = drawn ? "draw" : won ? "i_win" : "you_win";
  human.conclude(won, drawn, code, sentence(code, {}));
}

void Game::State::receive_engine_move(const std::string& text) {
  if (!thinking || real_to_move()) return;  // an answer to a question that no longer matters
  thinking = false;
  if (text == opponent_resigns) {
    const bool light_resigns = options.virtual_side == Side::light;
    return finish({light_resigns ? GameResult::dark_wins : GameResult::light_wins, "resigned"});
  }
  const auto move = read_move(*rules, record.position(), text);
  if (!move) {
    out.rejected.push_back("The engine's move was not taken: " + move.error().message);
    ask_engine = true;
    return;
  }
  pending = PendingMove{*move, 0, false, now_ns};
}

void Game::State::tell_move() {
  if (options.both_real) {
    GameEvent& e = event(EventKind::turn);
    const Route way = routes(*rules, record.position(), pending->move).front();
    e.code = "make_it_for_me";
    e.move = pdn_text(*rules, record.position(), pending->move);
    e.squares = way.squares;
    e.captured = way.captured;
    return ask_to_move();
  }
  const Route route = routes(*rules, record.position(), pending->move).front();
  pending->grasp = human.move(names[route.squares.front()], route.squares, pending->second_try);
  pending->told_ns = now_ns;
}

// Points out and says what the real player is to do with the virtual player's real pieces.
void Game::State::ask_to_move() {
  const Route route = routes(*rules, record.position(), pending->move).front();
  pending->grasp = human.ask_to_move(route.squares, favour_sentence(route.squares, route.captured));
  pending->told_ns = now_ns;
}

void Game::State::hear(const Feedback& feedback) {
  human.hear(feedback);
  if (is_final(feedback.state) && lost.ended(feedback.command_id)) show_scene();
  if (options.both_real || !pending || pending->grasp == 0) return;
  if (feedback.command_id != pending->grasp || !is_final(feedback.state)) return;
  if (feedback.state == FeedbackState::finished) {
    landed();
  } else if (!pending->second_try) {
    pending->second_try = true;
    pending->grasp = 0;
    // Wherever the first try has left the piece, the second one starts from its square.
    show_scene();
    if (phase == GamePhase::virtual_to_move && !lost.under_way()) tell_move();
  } else {
    landed();
    show_scene();
  }
}

// The virtual piece stands where it should: the move is made.
void Game::State::landed() {
  const Move move = pending->move;
  const bool by_hand = now_ns - pending->told_ns <= hand_patience_ns;
  pending.reset();
  const bool was_man = (record.position().kings & one(move.from)) == 0;
  commit(move);
  const bool crowned = was_man && (record.position().kings & one(move.to)) != 0;
  if (crowned || !by_hand || options.both_real) show_scene();
  const GamePhase before = phase;
  if (move.captured != 0 && !options.both_real && !record.ending()) {
    to_remove = move.captured;
    phase = GamePhase::waiting_for_removal;
    ask_for_removal(false);
  } else {
    hand_over();
  }
  if (before == GamePhase::paused || before == GamePhase::illegal) {
    behind = phase;
    phase = phase == GamePhase::over ? phase : before;
  }
}

void Game::State::ask_for_removal(bool again) {
  reminded_ns = now_ns;
  if (!again) {
    GameEvent& waiting = event(EventKind::waiting_for_removal);
    waiting.side = real_side();
    waiting.captured = squares(to_remove);
    waiting.squares = waiting.captured;
  }
  Bits still = to_remove;
  if (again && eyes.steady_ns(now_ns) >= 0) still &= eyes.reading().occupied | eyes.reading().unknown;
  if (still == 0) still = to_remove;
  human.point_at(squares(still).front(), "remove_captured", sentence("remove_captured", squares(still)));
}

void Game::State::removal_done() {
  GameEvent& done = event(EventKind::removal_done);
  done.side = real_side();
  done.captured = squares(to_remove);
  to_remove = 0;
  human.say("thanks", sentence("thanks", {}));
  hand_over();
  show_scene();
}

void Game::State::renderer_joined() {
  human.enter();
  // Hands that are told again go on under other ids; those of a process that is no more have done what they were to do.
  for (LostPiece& piece : lost.all()) {
    const std::uint64_t now = human.current_id(piece.grasp);
    piece.grasp = now == piece.grasp ? 0 : now;
  }
  lost_told_ns = now_ns;
  show_scene();
  if (pending) {
    // After a restart of this process the grasp that was on its way is not among what was told: tell it again.
    const std::uint64_t now = human.current_id(pending->grasp);
    pending->grasp = now == pending->grasp ? 0 : now;
    pending->told_ns = now_ns;
  }
}

void Game::State::restart(const Position& start) {
  human.stop();
  record = Record(*rules, start);
  name_pieces();
  phase = behind = GamePhase::setting_up;
  result = GameResult::open;
  result_code.clear();
  started = thinking = ask_engine = false;
  pending.reset();
  to_remove = 0;
  announced.reset();
  stops.clear();
  show_scene();
}

GameEvent& Game::State::event(EventKind kind) {
  GameEvent e;
  e.id = next_event++;
  e.kind = kind;
  e.side = record.position().turn;
  e.stamp_ns = now_ns;
  out.events.push_back(std::move(e));
  return out.events.back();
}

std::vector<int> Game::State::squares(Bits bits) const {
  return squares_of_bits(bits, rules->squares);
}

BoardState Game::State::board_state() const {
  BoardState state;
  state.rules = rules->name;
  state.squares = write_squares(*rules, record.position());
  state.turn = record.position().turn;
  state.virtual_side = options.virtual_side;
  state.phase = phase;
  state.result = result;
  for (std::size_t i = 0; i < record.moves().size(); ++i) {
    state.moves.push_back(pdn_text(*rules, record.position_before(i), record.moves()[i]));
  }
  state.to_remove = squares(to_remove);
  if (!(record.start() == start_position(*rules))) state.start_fen = write_fen(*rules, record.start());
  return state;
}

Scene Game::State::scene() const {
  Scene scene;
  scene.revision = scene_revision;
  scene.board = options.board;
  scene.table_height_m = options.table_height_m;
  scene.virtual_side = options.virtual_side;
  const Position& p = record.position();
  for (const auto& [square, name] : names) {
    const Bits bit = square_mask(square, rules->squares);
    ScenePiece piece;
    piece.name = name;
    piece.side = (p.light & bit) != 0 ? Side::light : Side::dark;
    piece.king = (p.kings & bit) != 0 && !lost.awaits_crown(name);
    piece.real = options.both_real || piece.side == real_side();
    piece.p_B = centre_of_square_B(square, options.board);
    scene.pieces.push_back(std::move(piece));
  }
  lost.show(scene.pieces);
  return scene;
}

void Game::State::show_scene() {
  ++scene_revision;
  out.scene = scene();
}

// Names follow the pieces from their first squares through the whole game.
void Game::State::name_pieces() {
  names.clear();
  lost = LostPieces(options.board, options.virtual_side);
  const Position& p = record.start();
  for (const int square : squares(p.light | p.dark)) {
    const Side side = (p.light & square_mask(square, rules->squares)) != 0 ? Side::light : Side::dark;
    names[square] = std::string(side_name(side)) + "_" + std::to_string(square);
  }
  for (std::size_t i = 0; i < record.moves().size(); ++i) {
    const Position before = record.position_before(i);
    move_names(before, record.moves()[i], routes(*rules, before, record.moves()[i]).front());
  }
  lost.settle();
}

// What the virtual player loses lies beside the board, and crowns his men that become kings.
void Game::State::move_names(const Position& before, const Move& move, const Route& route) {
  std::string name = names[route.squares.front()];
  names.erase(route.squares.front());
  for (const int square : route.captured) {
    if (before.turn == real_side() && !options.both_real) {
      lost.capture(names[square], (before.kings & square_mask(square, rules->squares)) != 0, square);
    }
    names.erase(square);
  }
  const bool crowns_by_hand = before.turn == options.virtual_side && !options.both_real;
  if (crowns_by_hand && is_crowned(*rules, before, move)) lost.crown(name, route.squares.back());
  names[route.squares.back()] = std::move(name);
}

// His hands take what has just left its place to where it belongs.
void Game::State::carry_lost() {
  for (LostPiece& piece : lost.all()) {
    if (!std::exchange(piece.to_carry, false)) continue;
    piece.grasp = human.carry(piece.name, piece.place_B);
    lost_told_ns = now_ns;
  }
}

// Nobody says what became of his hands: the pieces are where they belong without them.
void Game::State::set_lost_down() {
  lost.settle();
  show_scene();
}

Game::Game(std::unique_ptr<State> state) : state_(std::move(state)) {}
Game::Game(Game&&) noexcept = default;
Game& Game::operator=(Game&&) noexcept = default;
Game::~Game() = default;

Result<Game> Game::start(const GameOptions& options) {
  const Rules* rules = find_rules(options.rules);
  if (rules == nullptr) {
    return failure(ErrorCode::invalid_argument,
                   "There are no rules named \"" + options.rules + "\"; use international, brazilian or english.");
  }
  if (options.board.squares != rules->squares) {
    return failure(ErrorCode::invalid_argument, "The " + options.rules + " game needs a board of " +
                                                    std::to_string(rules->squares) + " squares a side, this one has " +
                                                    std::to_string(options.board.squares) + ".");
  }
  Position start = start_position(*rules);
  if (!options.start_fen.empty()) {
    const auto read = read_fen(*rules, options.start_fen);
    if (!read) return tl::make_unexpected(read.error());
    start = *read;
  }
  auto state = std::make_unique<State>(options, *rules, start, 1);
  state->shown = state->board_state();
  state->shown.revision = state->revision;
  return Game(std::move(state));
}

GameOutputs Game::step(const GameInputs& inputs) {
  state_->step(inputs);
  return std::exchange(state_->out, {});
}

const BoardState& Game::board_state() const {
  return state_->shown;
}

Scene Game::scene() const {
  return state_->scene();
}

std::string Game::pdn() const {
  PdnTags tags;
  tags.event = "Counterpart";
  (state_->options.virtual_side == Side::light ? tags.light : tags.dark) = "Counterpart";
  (state_->options.virtual_side == Side::light ? tags.dark : tags.light) = "Player";
  return write_pdn(tags, state_->record, state_->result);
}

}  // namespace counterpart
