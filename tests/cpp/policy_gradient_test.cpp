// Trainings of a few updates, of sizes that no vector and no chunk divides: what sanitizers watch.
#include <cmath>

#include "check.hpp"
#include "policy_gradient/training.hpp"

using namespace botschool;
using namespace botschool::policy_gradient;

namespace {

Hyperparameters odd() {
  Hyperparameters h;
  h.n_envs = 5, h.n_steps = 13, h.batch_size = 9, h.n_epochs = 2;
  h.pi = {7, 3}, h.vf = {5};
  h.normalize = true;
  return h;
}

/// The parameters after three updates.
std::vector<float> trained(const char* problem, const Hyperparameters& h, const std::string& isa) {
  Training training(problem, 20, h, isa);
  for (int update = 0; update < 3; ++update) {
    training.collect();
    const Update found = training.update(1e-3, 0.2, update == 1 ? 0.1 : 0);
    CHECK(found.finite && found.minibatches == 16);
  }
  for (const float each : training.learner.parameters) CHECK(std::isfinite(each));
  return training.learner.parameters;
}

}  // namespace

TEST(trainings_have_the_same_bits_on_all_threads_and_instruction_sets) {
  Hyperparameters relu = odd(), shared = odd(), none = odd();
  relu.relu = true, relu.ortho_init = false;
  shared.shared = {6, 4}, shared.pi = shared.vf = {};
  none.pi = none.vf = {}, none.normalize = none.normalize_advantage = false;
  for (const char* problem : {"CartPole-v1", "Pendulum-v1"})
    for (Hyperparameters h : {odd(), relu, shared, none}) {
      const auto expected = trained(problem, h, "baseline");
      h.threads = 3;
      for (const std::string& isa : instruction_sets()) CHECK(trained(problem, h, isa) == expected);
    }
}

TEST(an_agent_plays_and_looks_at_any_number_of_observations) {
  const Hyperparameters h = odd();
  Training training("Pendulum-v1", 30, h, "");
  const std::uint64_t seeds[] = {1, 2, 3};
  const std::uint32_t episodes[] = {0, 1, 2};
  double returns[3];
  std::int32_t lengths[3];
  training.experience.play(training.learner.parameters.data(), 3, seeds, episodes, returns,
                           lengths);
  for (int i = 0; i < 3; ++i) CHECK(lengths[i] == 30 && returns[i] < 0);
  for (const int n : {1, 7, 300}) {
    const std::vector<float> observations(std::size_t(n) * training.agent.inputs(), 0.5f);
    std::vector<float> outputs(std::size_t(n) * training.agent.outputs()), values(n);
    training.forward(observations.data(), n, outputs.data(), values.data());
    CHECK(values.front() == values.back() &&
          outputs.front() == outputs[outputs.size() - training.agent.outputs()]);
  }
}

TEST(a_minibatch_of_chosen_rows_has_a_gradient) {
  Training training("CartPole-v1", 0, odd(), "");
  training.collect();
  const std::vector<int> rows{64, 0, 3};
  const Indicators found =
      training.learner.loss(training.samples(), rows.data(), 3, 0.2, 0, nullptr, nullptr);
  CHECK(std::isfinite(found.policy_loss));
  CHECK(training.learner.step(training.learner.gradient(), 1e-3));
}

TEST(advantages_stop_where_episodes_end) {
  Rollout r;
  r.n_steps = 3;
  r.n_envs = 2;
  std::vector<float> values{1, 2, 3, 4, 5, 6}, rewards(6, 1.0f), ended{0, 0, 1, 0, 0, 2},
      last{10, 20}, advantages(6), returns(6);
  r.values = values.data(), r.rewards = rewards.data(), r.ended = ended.data();
  r.last_values = last.data();
  advantages_of(r, 0.5, 0.5, advantages.data(), returns.data());
  // by hand: delta = r + gamma V' - V, A = delta + gamma lambda A'
  const std::vector<float> expected{1.5f - 0.25f * 2, 1 - 0.25f * 1.25f, -2, 0 - 0.25f * 5, 1, -5};
  CHECK(advantages == expected);
  CHECK(returns[0] == advantages[0] + 1);
}

TEST(trainings_that_cannot_be_are_refused) {
  Hyperparameters many = odd(), nothing = odd();
  many.n_envs = 70000, nothing.batch_size = 0;
  CHECK(refused([&] { Training("CartPole-v1", 0, many, ""); }, "65535"));
  CHECK(refused([&] { Training("CartPole-v1", 0, nothing, ""); }, "at least 1"));
  CHECK(refused([&] { Training("ErPredprey", 0, odd(), ""); }, "several robots"));
}
