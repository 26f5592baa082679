#include "game_controller/referee/sentences.hpp"

#include <array>
#include <utility>

namespace counterpart {
namespace {

// # stands for the squares.
constexpr std::array<std::pair<std::string_view, std::string_view>, 39> sentences{{
    {"no_change", "Nothing has moved. It is still your turn."},
    {"not_your_turn", "It is not your turn. Please put the piece on # back."},
    {"must_capture", "You can capture a piece, so you must. Look at the piece on #."},
    {"not_maximum", "You must take as many pieces as you can. There is a bigger capture for the piece on #."},
    {"capture_not_finished", "Your piece can go on capturing. Jump on to the end."},
    {"captured_left_on_board", "You jumped over the piece on #. Please take it off the board."},
    {"wrong_piece_removed", "You took off the piece on #, but that is not the one you jumped over."},
    {"extra_piece_removed", "The piece on # was not captured. Please put it back."},
    {"piece_vanished", "A piece is missing. It should stand on #."},
    {"piece_appeared", "There is a piece on # that was not there before."},
    {"two_pieces_moved", "You may move only one piece in a turn. Look at #."},
    {"opponent_piece_moved", "The piece on # is not yours, so you may not move it."},
    {"moved_backwards", "A man moves forwards only. It may go backwards only to capture."},
    {"moved_too_far", "A man moves just one square at a time."},
    {"not_diagonal", "Pieces move along the slanting lines only."},
    {"light_square", "There is a piece beside the squares we play on. Please put it on one of the right squares."},
    {"path_blocked", "A king cannot pass over its own pieces, nor over two pieces in a row. Look at #."},
    {"jumped_own_piece", "You cannot jump over your own piece on #."},
    {"wrong_landing", "Your piece cannot land on # there."},
    {"not_crowned", "The man on # has reached the last row, so it is a king now. Please crown it."},
    {"crowned_wrongly", "The man on # has not ended its move on the last row, so it is no king."},
    {"piece_jumped_twice", "You may jump over each piece only once, and it stays there until your move is over."},
    {"virtual_piece_there", "My piece stands on #, so yours cannot be there."},
    {"not_as_asked", "That is not the move that I asked you to make for me. Look at #."},
    {"remove_captured", "I have captured your piece on #. Please take it off the board."},
    {"put_back", "Please put the pieces back as they were."},
    {"which_capture", "I could not see which way you captured. Please show me, or put the piece back and move again."},
    {"board_unclear", "I cannot see #."},
    {"board_turned", "The board is turned round. Please turn it, or your pieces, to the other side."},
    {"set_up", "Please put your pieces on their squares. Look at #."},
    {"thanks", "Thank you."},
    {"you_win", "You have won. Well played!"},
    {"i_win", "I have won. Thank you for the game!"},
    {"draw", "It is a draw. Thank you for the game!"},
    {"begin", "Let us play. I begin."},
    {"you_begin", "Let us play. You begin."},
    {"crowned", "Your man on # is a king now."},
    {"backward_capture", "Yes, a man may capture backwards too."},
    {"majority", "One must always take as many pieces as possible, so it had to be the piece on #."},
}};

}  // namespace

std::string listed(const std::vector<int>& squares) {
  std::string text;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (i > 0) text += i + 1 == squares.size() ? " and " : ", ";
    text += std::to_string(squares[i]);
  }
  return text;
}

std::string favour_sentence(const std::vector<int>& route, const std::vector<int>& captured) {
  std::string text =
      "Please move my piece from " + std::to_string(route.front()) + " to " + std::to_string(route.back()) + " for me";
  if (!captured.empty())
    text += ", and take your " + std::string(captured.size() > 1 ? "pieces" : "piece") + " on " + listed(captured) +
            " off the board";
  return text + ".";
}

std::string sentence(std::string_view reason, const std::vector<int>& squares, const std::vector<std::string>& legal) {
  for (const auto& [code, words] : sentences) {
    if (code != reason) continue;
    std::string text(words);
    const auto place = text.find('#');
    if (place != std::string::npos) {
      const std::string name =
          squares.empty() ? "the board" : (squares.size() > 1 ? "squares " : "square ") + listed(squares);
      text.replace(place, 1, name);
    }
    if (!legal.empty()) text += " For example, " + legal.front() + " is allowed.";
    return text;
  }
  return "That is not allowed.";
}

}  // namespace counterpart
