#include "agent.hpp"

#include <cmath>
#include <stdexcept>

#include "../evonet/philox.hpp"

namespace botschool::policy_gradient {
namespace {

Net make_net(int inputs, const std::vector<int>& hidden, int outputs, int& place) {
  std::vector<int> widths = hidden;
  if (outputs) widths.push_back(outputs);
  if (widths.size() > std::size_t(kMaxLayers))
    throw std::invalid_argument("a network has at most " + std::to_string(kMaxLayers - 1) +
                                " hidden layers.");
  Net net;
  net.ends_linear = outputs > 0;
  net.width[0] = inputs;
  for (const int width : widths) {
    if (width < 1) throw std::invalid_argument("a layer needs at least one neuron.");
    const int before = net.width[net.layers];
    net.weights[net.layers] = place;
    net.biases[net.layers] = place + width * before;
    place += width * before + width;
    net.width[++net.layers] = width;
  }
  return net;
}

/// Orthonormal rows or columns, whichever are fewer, times gain (Saxe and others 2014).
void orthogonal(float* weights, int rows, int columns, double gain, Random& random) {
  const int few = std::min(rows, columns), many = std::max(rows, columns);
  std::vector<double> q(std::size_t(few) * many);
  for (double& x : q) x = random.gaussian();
  for (int i = 0; i < few; ++i) {
    double* row = &q[std::size_t(i) * many];
    for (int j = 0; j < i; ++j) {
      const double* other = &q[std::size_t(j) * many];
      double product = 0;
      for (int k = 0; k < many; ++k) product += row[k] * other[k];
      for (int k = 0; k < many; ++k) row[k] -= product * other[k];
    }
    double square = 0;
    for (int k = 0; k < many; ++k) square += row[k] * row[k];
    for (int k = 0; k < many; ++k) row[k] /= std::sqrt(square);
  }
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      weights[i * columns + j] = static_cast<float>(
          gain * (rows <= columns ? q[std::size_t(i) * many + j] : q[std::size_t(j) * many + i]));
}

void initialise(const Net& net, double last_gain, bool ortho, Random& random, float* parameters) {
  for (int l = 0; l < net.layers; ++l) {
    const int rows = net.width[l + 1], columns = net.width[l];
    float* weights = parameters + net.weights[l];
    const double limit = 1 / std::sqrt(static_cast<double>(columns));
    const bool last = l + 1 == net.layers && net.ends_linear;
    if (ortho)
      orthogonal(weights, rows, columns, last ? last_gain : std::sqrt(2.0), random);
    else
      for (int i = 0; i < rows * columns; ++i)
        weights[i] = static_cast<float>(random.uniform(-limit, limit));
    std::fill_n(parameters + net.biases[l], rows, 0.0f);
  }
}

int round_up(int values) { return (values + 15) / 16 * 16; }

}  // namespace

Agent make_agent(int inputs, int outputs, bool discrete, const Hyperparameters& h) {
  Agent agent;
  agent.relu = h.relu;
  agent.discrete = discrete;
  agent.body = make_net(inputs, h.shared, 0, agent.size);
  agent.actor = make_net(agent.body.outputs(), h.pi, outputs, agent.size);
  agent.critic = make_net(agent.body.outputs(), h.vf, 1, agent.size);
  agent.log_std = agent.size;
  if (!discrete) agent.size += outputs;
  return agent;
}

void initialise(const Agent& agent, const Hyperparameters& h, float* parameters) {
  Random random(h.seed, 0, Stream::weights);
  initialise(agent.body, 1.0, h.ortho_init, random, parameters);
  initialise(agent.actor, 0.01, h.ortho_init, random, parameters);
  initialise(agent.critic, 1.0, h.ortho_init, random, parameters);
  std::fill(parameters + agent.log_std, parameters + agent.size,
            static_cast<float>(h.log_std_init));
}

Workspace::Workspace(const Agent& agent) {
  int widest = agent.inputs();
  for (const Net* net : {&agent.body, &agent.actor, &agent.critic})
    for (int l = 1; l <= net->layers; ++l) widest = std::max(widest, net->width[l]);
  std::size_t used = 0;
  std::vector<std::pair<float**, std::size_t>> parts;
  const auto add = [&](float*& part, int values) {
    parts.emplace_back(&part, used);
    used += std::size_t(values) * kChunk / 16;
  };
  add(scratch.observations, agent.inputs());
  for (int l = 0; l < agent.body.layers; ++l) add(scratch.body[l], agent.body.width[l + 1]);
  for (int l = 0; l < agent.actor.layers; ++l) add(scratch.actor[l], agent.actor.width[l + 1]);
  for (int l = 0; l < agent.critic.layers; ++l) add(scratch.critic[l], agent.critic.width[l + 1]);
  add(scratch.slope[0], widest);
  add(scratch.slope[1], widest);
  add(scratch.features_slope, agent.body.outputs());
  add(scratch.critic_features, agent.body.outputs());
  add(scratch.turned, round_up(widest));
  add(scratch.chances, agent.outputs());
  lines_.resize(used);
  for (const auto& [part, place] : parts) *part = lines_[place].value;
}

}  // namespace botschool::policy_gradient
