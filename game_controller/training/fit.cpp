#include "game_controller/training/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "game_controller/engine/dice.hpp"
#include "game_controller/engine/evaluate.hpp"

namespace counterpart {
namespace {

constexpr float logits_a_man = 1.2F;  // how surely a man more wins in these games, to read the search's values

struct Knob {
  float value = 0;
  float seen = 10;  // sum of squared gradients; so much at first that one sight of a rare pattern teaches little
};

// The regression's own weights: two knobs where the evaluation has one staged weight. What halves of a block are worth
// is learnt too and added to the whole in the end: a pattern that was hardly ever seen is judged by its halves.
struct Model {
  std::array<std::array<std::array<Knob, 2>, pattern_states>, pattern_count> patterns;
  std::array<std::array<std::array<Knob, 2>, half_pattern_states>, pattern_count> first_halves;
  std::array<std::array<std::array<Knob, 2>, half_pattern_states>, pattern_count> second_halves;
  std::array<std::array<Knob, 2>, extra_count> extras;
};

float sigmoid(float x) {
  return 1 / (1 + std::exp(-x));
}

float logistic_loss(float predicted, float target) {
  constexpr float tiny = 1e-6F;
  const float p = std::clamp(predicted, tiny, 1 - tiny);
  return -(target * std::log(p) + (1 - target) * std::log(1 - p));
}

constexpr std::size_t first_half(std::size_t state) {
  return state / half_pattern_states;
}

constexpr std::size_t second_half(std::size_t state) {
  return state % half_pattern_states;
}

class Regression {
 public:
  Regression(const FitOptions& options) : options_(options), model_(std::make_unique<Model>()) {
    if (options.start != nullptr) {
      begin_with(*options.start);
      return;
    }
    for (Knob& knob : model_->extras[extra_men]) knob.value = logits_a_man;
    for (Knob& knob : model_->extras[extra_first_king]) knob.value = 3 * logits_a_man;
    for (Knob& knob : model_->extras[extra_further_kings]) knob.value = 3 * logits_a_man;
  }

  float target(const Lesson& lesson) const {
    const auto trust = static_cast<float>(options_.trust_in_search);
    const float thought = sigmoid(logits_a_man * lesson.value);
    return lesson.result ? (1 - trust) * *lesson.result + trust * thought : thought;
  }

  float predict(const PatternView& view) const {
    const float full = share(view);
    float sum = 0;
    const auto mixed_value = [&](const std::array<Knob, 2>& knobs) {
      return full * knobs[0].value + (1 - full) * knobs[1].value;
    };
    for (std::size_t i = 0; i < pattern_count; ++i) {
      const auto block_value = [&](std::size_t state) {
        return mixed_value(model_->patterns[i][state]) + mixed_value(model_->first_halves[i][first_half(state)]) +
               mixed_value(model_->second_halves[i][second_half(state)]);
      };
      sum += block_value(view.states[i]) - block_value(view.states[pattern_count + i]);
    }
    for (std::size_t i = 0; i < extra_count; ++i) {
      sum += mixed_value(model_->extras[i]) * static_cast<float>(view.extras[i]);
    }
    return sigmoid(sum);
  }

  void learn(const PatternView& view, float error) {
    for (std::size_t i = 0; i < pattern_count; ++i) {
      const auto turn_block = [&](std::size_t state, float share_of_error) {
        turn(model_->patterns[i][state], view, share_of_error);
        turn(model_->first_halves[i][first_half(state)], view, share_of_error);
        turn(model_->second_halves[i][second_half(state)], view, share_of_error);
      };
      turn_block(view.states[i], error);
      turn_block(view.states[pattern_count + i], -error);
    }
    for (std::size_t i = 0; i < extra_count; ++i) {
      if (view.extras[i] != 0) turn(model_->extras[i], view, error * static_cast<float>(view.extras[i]));
    }
  }

  PatternWeights rounded() const {
    const auto& men = model_->extras[extra_men];
    const float scale = man_value * weight_unit / std::max((men[0].value + men[1].value) / 2, 0.1F);
    const auto weight = [&](float value) {
      return static_cast<std::int16_t>(std::lround(std::clamp(value * scale, -32000.0F, 32000.0F)));
    };
    PatternWeights weights;
    for (std::size_t i = 0; i < pattern_count; ++i) {
      for (std::size_t s = 0; s < pattern_states; ++s) {
        const auto& whole = model_->patterns[i][s];
        const auto& first = model_->first_halves[i][first_half(s)];
        const auto& second = model_->second_halves[i][second_half(s)];
        const auto sum = [&](std::size_t stage) {
          return whole[stage].value + first[stage].value + second[stage].value;
        };
        weights.patterns[i][s] = {weight(sum(0)), weight(sum(1))};
      }
    }
    for (std::size_t i = 0; i < extra_count; ++i) {
      weights.extras[i] = {weight(model_->extras[i][0].value), weight(model_->extras[i][1].value)};
    }
    return weights;
  }

 private:
  void begin_with(const PatternWeights& weights) {
    constexpr float scale = logits_a_man / (man_value * weight_unit);
    const auto begin = [](std::array<Knob, 2>& knobs, const StagedWeight& weight) {
      knobs[0].value = scale * static_cast<float>(weight.opening);
      knobs[1].value = scale * static_cast<float>(weight.ending);
    };
    for (std::size_t i = 0; i < pattern_count; ++i) {
      for (std::size_t s = 0; s < pattern_states; ++s) begin(model_->patterns[i][s], weights.patterns[i][s]);
    }
    for (std::size_t i = 0; i < extra_count; ++i) begin(model_->extras[i], weights.extras[i]);
  }

  static float share(const PatternView& view) {
    return static_cast<float>(view.stage) / static_cast<float>(full_stage);
  }

  void turn(std::array<Knob, 2>& knobs, const PatternView& view, float error) {
    const float full = share(view);
    turn(knobs[0], error * full);
    turn(knobs[1], error * (1 - full));
  }

  void turn(Knob& knob, float gradient) {
    gradient += static_cast<float>(options_.shrink) * knob.value;
    knob.seen += gradient * gradient;
    knob.value -= static_cast<float>(options_.step) * gradient / std::sqrt(knob.seen);
  }

  FitOptions options_;
  std::unique_ptr<Model> model_;
};

}  // namespace

PatternWeights fit(const std::vector<Lesson>& lessons, const FitOptions& options,
                   const std::function<void(const FitProgress&)>& on_epoch) {
  Regression regression(options);
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> held_back;
  for (std::uint32_t i = 0; i < lessons.size(); ++i) {
    (lessons[i].game % options.held_back == 0 ? held_back : order).push_back(i);
  }
  Dice dice(options.seed);
  for (int epoch = 1; epoch <= options.epochs; ++epoch) {
    for (std::size_t i = order.size(); i > 1; --i) {
      std::swap(order[i - 1], order[static_cast<std::size_t>(dice.roll(static_cast<int>(i)))]);
    }
    FitProgress progress{epoch, 0, 0};
    for (const std::uint32_t i : order) {
      const PatternView view = view_patterns(lessons[i].position);
      const float predicted = regression.predict(view);
      const float wanted = regression.target(lessons[i]);
      progress.loss += logistic_loss(predicted, wanted);
      regression.learn(view, predicted - wanted);
    }
    for (const std::uint32_t i : held_back) {
      const float predicted = regression.predict(view_patterns(lessons[i].position));
      progress.held_back_loss += logistic_loss(predicted, regression.target(lessons[i]));
    }
    progress.loss /= static_cast<double>(std::max<std::size_t>(order.size(), 1));
    progress.held_back_loss /= static_cast<double>(std::max<std::size_t>(held_back.size(), 1));
    if (on_epoch) on_epoch(progress);
  }
  return regression.rounded();
}

}  // namespace counterpart
