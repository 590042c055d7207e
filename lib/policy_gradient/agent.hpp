// A policy and a critic (section 2 of walkthroughs/ppo.py): where their parameters stand in one vector, and the memory that a thread
// needs to compute with them. An optional body of hidden layers comes before both.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "hyperparameters.hpp"

namespace botschool::policy_gradient {

/// Samples that a gradient is summed over in one go; chunks are then added pairwise.
constexpr int kChunk = 64;
constexpr int kMaxLayers = 8;

/// Layers that follow each other. The weights of a layer, [outputs][inputs], stand before its biases.
struct Net {
  int layers = 0;
  int width[kMaxLayers + 1] = {};  ///< what goes in, then what comes out of each layer
  int weights[kMaxLayers] = {}, biases[kMaxLayers] = {};  ///< places in the agent's parameters
  bool ends_linear = true;  ///< whether the last layer has no activation

  int outputs() const { return width[layers]; }
};

struct Agent {
  Net body, actor, critic;
  bool relu = false, discrete = false;
  int log_std = 0;  ///< place of the Gaussian's logarithms of deviations, outputs() of them
  int size = 0;     ///< of all parameters

  int inputs() const { return body.width[0]; }
  int outputs() const { return actor.outputs(); }
  /// Numbers of an action: one of a discrete problem.
  int actuators() const { return discrete ? 1 : outputs(); }
};

/// What one thread computes with; all arrays are [values][samples].
struct Scratch {
  float* observations;
  float* body[kMaxLayers];  ///< what comes out of each layer
  float* actor[kMaxLayers];
  float* critic[kMaxLayers];
  float* slope[2];         ///< d loss / d the values of a layer, and of the one before
  float* features_slope;   ///< d loss / d what comes out of the body, by the policy
  float* critic_features;  ///< and by the critic
  float* turned;           ///< [samples][values]
  float* chances;          ///< of each action, or how far each one is from the mean in deviations

  const float* features(const Agent& agent) const {
    return agent.body.layers ? body[agent.body.layers - 1] : observations;
  }
  const float* outputs(const Agent& agent) const { return actor[agent.actor.layers - 1]; }
  const float* values(const Agent& agent) const { return critic[agent.critic.layers - 1]; }
};

/// Agents of these inputs and outputs. Throws std::invalid_argument for too many layers.
Agent make_agent(int inputs, int outputs, bool discrete, const Hyperparameters& h);

/// First parameters of an agent: orthogonal weights (gain sqrt(2), of the policy's outputs 0.01, of the
/// critic's 1) or weights as in torch's linear layers; biases 0.
void initialise(const Agent& agent, const Hyperparameters& h, float* parameters);

/// Memory of a Scratch, in lines of 64 bytes.
class Workspace {
 public:
  explicit Workspace(const Agent& agent);
  Scratch scratch{};

 private:
  struct alignas(64) Line {
    float value[16];
  };
  std::vector<Line> lines_;
};

}  // namespace botschool::policy_gradient
