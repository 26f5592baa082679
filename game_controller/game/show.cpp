#include "game_controller/game/show.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace counterpart {
namespace {

constexpr const char* kPiece = "light_show";

double distance(const Point3& a, const Point3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

bool holds_piece(CellReading reading) {
  return reading == CellReading::dark || reading == CellReading::light || reading == CellReading::piece;
}

// The middle of the virtual player's edge of the board.
Point3 seat_edge_B(const BoardGeometry& board, Side virtual_side) {
  const double half = board.squares * board.square_size_m / 2;
  return {0, virtual_side == Side::light ? -half : half, 0};
}

struct CellPlaces {
  std::vector<Cell> pieces, empties;
};

CellPlaces sort_cells(const Occupancy& sight) {
  CellPlaces out;
  for (int row = 0; row < sight.squares; ++row) {
    for (int col = 0; col < sight.squares; ++col) {
      const auto reading = sight.cells[static_cast<std::size_t>(row * sight.squares + col)].reading;
      if (holds_piece(reading)) out.pieces.push_back({row, col});
      if (reading == CellReading::empty) out.empties.push_back({row, col});
    }
  }
  return out;
}

// The cell whose centre is nearest to a point.
std::optional<Cell> nearest(const std::vector<Cell>& cells, const Point3& p_B, const BoardGeometry& board) {
  std::optional<Cell> best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const Cell& cell : cells) {
    const double d = distance(centre_of_cell_B(cell, board), p_B);
    if (d < best_distance) best = cell, best_distance = d;
  }
  return best;
}

// Empty cells that touch no piece: the hand has room there.
std::vector<Cell> roomy(const CellPlaces& cells) {
  std::vector<Cell> out;
  for (const Cell& cell : cells.empties) {
    const bool touches = std::any_of(cells.pieces.begin(), cells.pieces.end(), [&](const Cell& piece) {
      return std::abs(piece.row - cell.row) <= 1 && std::abs(piece.col - cell.col) <= 1;
    });
    if (!touches) out.push_back(cell);
  }
  return out.empty() ? cells.empties : out;
}

}  // namespace

std::optional<Show> plan_show(const Occupancy& sight, const BoardGeometry& board, Side virtual_side,
                              double table_height_m) {
  const CellPlaces cells = sort_cells(sight);
  const Point3 edge_B = seat_edge_B(board, virtual_side);
  const double away = virtual_side == Side::light ? 1 : -1;  // from the seat over the board
  const double D = board.square_size_m;
  const Point3 near_B{0.5 * D, edge_B[1] + away * 1.5 * D, 0};
  const auto first = nearest(roomy(cells), near_B, board);
  if (!first) return std::nullopt;
  const Point3 first_B = centre_of_cell_B(*first, board);

  std::vector<Cell> others = roomy(cells);
  others.erase(std::remove(others.begin(), others.end(), *first), others.end());
  // A step forward as a man moves, or as near to it as is free.
  const auto second = nearest(others, {first_B[0] + D, first_B[1] + away * D, 0}, board);

  Show show;
  show.scene.board = board;
  show.scene.table_height_m = table_height_m;
  show.scene.virtual_side = virtual_side;
  // On the table, clear of the board's rim.
  const double beside_m = board.squares * D / 2 + board.border_m + 2 * board.piece_radius_m;
  const Point3 beside_B{beside_m, edge_B[1] + away * 1.5 * D, -board.thickness_m};
  show.scene.pieces.push_back({kPiece, Side::light, false, false, beside_B});

  for (const Cell& cell : cells.pieces) {
    const std::string name = "real_" + std::to_string(cell.row) + "_" + std::to_string(cell.col);
    show.scene.pieces.push_back({name, other(virtual_side), false, true, centre_of_cell_B(cell, board)});
  }

  std::uint64_t last = 0;
  const auto then = [&](Action action) {
    Command command;
    command.id = show.commands.size() + 1;
    command.action = std::move(action);
    if (last != 0) command.after = {last};
    last = command.id;
    show.commands.push_back(std::move(command));
  };
  // What accompanies the command before it.
  const auto meanwhile = [&](Action action) {
    Command command;
    command.id = show.commands.size() + 1;
    command.action = std::move(action);
    if (last != 0) command.after = show.commands[last - 1].after;
    show.commands.push_back(std::move(command));
  };

  Navigate sit;
  sit.place = "seat";
  sit.gait = "instant";
  then(sit);

  const auto target = nearest(cells.pieces, {0, edge_B[1], 0}, board);
  const Point3 target_B = target ? centre_of_cell_B(*target, board) : Point3{0, 0, 0};
  Grasp point;
  point.style = "point";
  point.path_B = {{target_B[0], target_B[1], 0.05}};
  point.duration_s = 2.2;
  then(point);
  Gaze look;
  look.target = GazeTarget::point;
  look.point_B = target_B;
  meanwhile(look);

  Grasp set_down;
  set_down.piece = kPiece;
  set_down.path_B = {first_B};
  set_down.duration_s = 2.8;
  then(set_down);
  look.point_B = first_B;
  meanwhile(look);

  if (second) {
    Grasp move;
    move.piece = kPiece;
    move.path_B = {centre_of_cell_B(*second, board)};
    move.duration_s = 2.4;
    then(move);
  }
  Gaze up;
  up.target = GazeTarget::player;
  then(up);
  Keyframe nod;
  nod.clip = "nod";
  then(nod);
  return show;
}

}  // namespace counterpart
