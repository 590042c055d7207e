// Trainings by policy gradients. Arrays are views of the training's own, unless they say otherwise.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "aim.hpp"
#include "policy_gradient/training.hpp"

namespace botschool {
namespace {

using namespace policy_gradient;
using Shape = std::vector<std::size_t>;

template <class T>
nb::object view(nb::handle owner, const T* data, const Shape& shape) {
  return nb::cast(
      nb::ndarray<nb::numpy, T>(const_cast<T*>(data), shape.size(), shape.data(), owner));
}

Training& training(nb::handle self) { return nb::cast<Training&>(self); }

nb::dict to_dict(const Indicators& found) {
  nb::dict d;
  d["policy_loss"] = found.policy_loss;
  d["value_loss"] = found.value_loss;
  d["entropy"] = found.entropy;
  d["approx_kl"] = found.approx_kl;
  d["clip_fraction"] = found.clip_fraction;
  return d;
}

nb::dict rollout(nb::handle self) {
  const Training& t = training(self);
  const policy_gradient::Rollout& r = t.experience.rollout;
  const std::size_t steps = r.n_steps, envs = r.n_envs;
  const Shape shape{steps, envs};
  nb::dict d;
  d["observations"] = view(self, r.observations, {steps, envs, std::size_t(t.agent.inputs())});
  d["actions"] = view(self, r.actions, {steps, envs, std::size_t(t.agent.actuators())});
  d["log_probs"] = view(self, r.log_probs, shape);
  d["values"] = view(self, r.values, shape);
  d["rewards"] = view(self, r.rewards, shape);
  d["ended"] = view(self, r.ended, shape);
  d["last_values"] = view(self, r.last_values, {envs});
  d["advantages"] = view(self, t.advantages.data(), shape);
  d["returns"] = view(self, t.returns.data(), shape);
  return d;
}

/// (name, shape, place) of each part of the parameters.
nb::list parts(const Agent& agent) {
  nb::list list;
  const auto add = [&](const char* name, const Net& net) {
    for (int l = 0; l < net.layers; ++l) {
      const std::string layer = std::string(name) + "." + std::to_string(l);
      const int rows = net.width[l + 1];
      list.append(
          nb::make_tuple(layer + ".weight", nb::make_tuple(rows, net.width[l]), net.weights[l]));
      list.append(nb::make_tuple(layer + ".bias", nb::make_tuple(rows), net.biases[l]));
    }
  };
  add("shared", agent.body);
  add("actor", agent.actor);
  add("critic", agent.critic);
  if (!agent.discrete)
    list.append(nb::make_tuple("log_std", nb::make_tuple(agent.outputs()), agent.log_std));
  return list;
}

nb::dict update(Training& t, double learning_rate, double clip_range, double clip_range_vf) {
  Update found;
  {
    nb::gil_scoped_release release;
    found = t.update(learning_rate, clip_range, clip_range_vf);
  }
  nb::dict d = to_dict(found.means);
  d["loss"] = found.loss;
  d["explained_variance"] = found.explained_variance;
  d["minibatches"] = found.minibatches;
  d["finite"] = found.finite;
  return d;
}

/// A minibatch of the caller's. The gradient is a copy.
nb::dict loss(Training& t, Matrix<const float> observations, Matrix<const float> actions,
              Vector<const float> log_probs, Vector<const float> values,
              Vector<const float> advantages, Vector<const float> returns, double clip_range,
              double clip_range_vf) {
  const std::size_t n = observations.shape(0);
  if (n < 1) throw std::invalid_argument("a minibatch needs at least one sample.");
  expect_size(observations, n * t.agent.inputs(), "the matrix of observations");
  expect_size(actions, n * t.agent.actuators(), "the matrix of actions");
  expect_size(log_probs, n, "the vector of log_probs");
  expect_size(values, n, "the vector of values");
  expect_size(advantages, n, "the vector of advantages");
  expect_size(returns, n, "the vector of returns");
  if (t.agent.discrete)
    for (std::size_t i = 0; i < n; ++i)
      if (!(actions.data()[i] >= 0 && actions.data()[i] < t.agent.outputs()))
        throw std::invalid_argument("there is no such action.");
  const Batch batch{observations.data(), actions.data(),    log_probs.data(),
                    values.data(),       advantages.data(), returns.data()};
  std::vector<int> rows(n);
  for (std::size_t i = 0; i < n; ++i) rows[i] = static_cast<int>(i);
  std::vector<float> new_log_probs(n), new_values(n);
  Indicators found;
  {
    nb::gil_scoped_release release;
    found = t.learner.loss(batch, rows.data(), static_cast<int>(n), clip_range, clip_range_vf,
                           new_log_probs.data(), new_values.data());
  }
  nb::dict d = to_dict(found);
  const float* g = t.learner.gradient();
  d["gradient"] = to_numpy(std::vector<float>(g, g + t.agent.size), {std::size_t(t.agent.size)});
  d["log_probs"] = to_numpy(std::move(new_log_probs), {n});
  d["values"] = to_numpy(std::move(new_values), {n});
  return d;
}

nb::tuple forward(Training& t, Matrix<const float> observations) {
  const std::size_t n = observations.shape(0), out = t.agent.outputs();
  expect_size(observations, n * t.agent.inputs(), "the matrix of observations");
  std::vector<float> outputs(n * out), values(n);
  t.forward(observations.data(), static_cast<int>(n), outputs.data(), values.data());
  return nb::make_tuple(to_numpy(std::move(outputs), {n, out}), to_numpy(std::move(values), {n}));
}

nb::tuple play(Training& t, Vector<const std::uint64_t> seeds,
               Vector<const std::uint32_t> episodes) {
  const std::size_t n = seeds.size();
  expect_size(episodes, n, "the vector of episodes");
  std::vector<double> returns(n);
  std::vector<std::int32_t> lengths(n);
  {
    nb::gil_scoped_release release;
    t.experience.play(t.learner.parameters.data(), static_cast<int>(n), seeds.data(),
                      episodes.data(), returns.data(), lengths.data());
  }
  return nb::make_tuple(to_numpy(std::move(returns), {n}), to_numpy(std::move(lengths), {n}));
}

/// Steps of the training, returns and lengths of the episodes that ended in the last rollout.
nb::tuple episodes(const Training& t) {
  std::vector<std::int64_t> steps, lengths;
  std::vector<double> returns;
  for (const Episode& e : t.experience.episodes) {
    steps.push_back(static_cast<std::int64_t>(e.steps));
    returns.push_back(e.total);
    lengths.push_back(e.length);
  }
  const std::size_t n = returns.size();
  return nb::make_tuple(to_numpy(std::move(steps), {n}), to_numpy(std::move(returns), {n}),
                        to_numpy(std::move(lengths), {n}));
}

/// Mean and variance of each observation so far; shape (2, inputs), a copy.
nb::object observed(const Training& t) {
  std::vector<double> values;
  for (const Moments& m : t.experience.seen) values.push_back(m.mean);
  for (const Moments& m : t.experience.seen) values.push_back(m.variance);
  return to_numpy(std::move(values), {2, t.experience.seen.size()});
}

void set_observed(Training& t, Matrix<const double> moments) {
  Experience& e = t.experience;
  expect_size(moments, 2 * e.seen.size(), "the matrix of means and variances");
  for (std::size_t i = 0; i < e.seen.size(); ++i) {
    e.seen[i].mean = moments.data()[i];
    e.seen[i].variance = moments.data()[e.seen.size() + i];
  }
  e.use_seen();
}

/// Between two updates, all that the rest of the training depends on: calls f(name, values, count).
template <class F>
void each_part(Training& t, const F& f) {
  Learner& l = t.learner;
  Experience& e = t.experience;
  f("parameters", l.parameters.data(), l.parameters.size());
  f("first", l.first.data(), l.first.size());
  f("second", l.second.data(), l.second.size());
  f("discounted", e.discounted.data(), e.discounted.size());
  f("recent", e.recent.data(), e.recent.size());
}

std::vector<double> numbers_of(const Training& t) {
  const Experience& e = t.experience;
  std::vector<double> n{t.learner.beta1_power, t.learner.beta2_power, e.paid.mean, e.paid.variance,
                        e.paid.count};
  for (const Moments& m : e.seen) n.insert(n.end(), {m.mean, m.variance, m.count});
  for (const Group& g : e.groups) n.insert(n.end(), g.total, g.total + kLanes);
  return n;
}

void set_numbers(Training& t, const double* n) {
  Experience& e = t.experience;
  t.learner.beta1_power = *n++;
  t.learner.beta2_power = *n++;
  e.paid.mean = *n++, e.paid.variance = *n++, e.paid.count = *n++;
  for (Moments& m : e.seen) m.mean = *n++, m.variance = *n++, m.count = *n++;
  for (Group& g : e.groups)
    for (double& total : g.total) total = *n++;
}

std::vector<std::uint64_t> counts_of(const Training& t) {
  std::vector<std::uint64_t> n{t.experience.steps, t.learner.updates};
  for (const Group& g : t.experience.groups)
    for (int l = 0; l < kLanes; ++l) n.push_back(g.episodes[l]), n.push_back(g.length[l]);
  return n;
}

void set_counts(Training& t, const std::uint64_t* n) {
  t.experience.steps = *n++;
  t.learner.updates = *n++;
  for (Group& g : t.experience.groups)
    for (int l = 0; l < kLanes; ++l) {
      g.episodes[l] = static_cast<std::uint32_t>(*n++);
      g.length[l] = static_cast<std::int32_t>(*n++);
    }
}

nb::dict state(Training& t) {
  nb::dict d;
  each_part(t, [&](const char* name, auto* values, std::size_t n) {
    d[name] = to_numpy(std::vector(values, values + n), {n});
  });
  std::vector<double> numbers = numbers_of(t);
  std::vector<std::uint64_t> counts = counts_of(t);
  d["numbers"] = to_numpy(std::move(numbers), {numbers.size()});
  d["counts"] = to_numpy(std::move(counts), {counts.size()});
  return d;
}

void restore(Training& t, const nb::dict& d) {
  const auto numbers = nb::cast<Vector<const double>>(d["numbers"]);
  const auto counts = nb::cast<Vector<const std::uint64_t>>(d["counts"]);
  expect_size(numbers, numbers_of(t).size(), "the state's numbers");
  expect_size(counts, counts_of(t).size(), "the state's counts");
  const auto check = [&](auto set) {
    each_part(t, [&](const char* name, auto* values, std::size_t n) {
      using T = std::remove_pointer_t<decltype(values)>;
      const auto given = nb::cast<Vector<const T>>(d[name]);
      expect_size(given, n, name);
      if (set) std::copy(given.data(), given.data() + n, values);
    });
  };
  for (std::size_t i = 2; i < counts.size(); i += 2)
    if (counts.data()[i] < 1 || counts.data()[i + 1] > std::uint64_t(t.limit))
      throw std::invalid_argument("the state's episodes are none of this training.");
  check(false);
  check(true);
  set_numbers(t, numbers.data());
  set_counts(t, counts.data());
  t.experience.restore();
}

}  // namespace

void bind_policy_gradient(nb::module_& module) {
  nb::class_<Hyperparameters>(module, "PolicyGradientHyperparameters")
      .def(nb::init<>())
      .def_rw("seed", &Hyperparameters::seed)
      .def_rw("n_envs", &Hyperparameters::n_envs)
      .def_rw("n_steps", &Hyperparameters::n_steps)
      .def_rw("batch_size", &Hyperparameters::batch_size)
      .def_rw("n_epochs", &Hyperparameters::n_epochs)
      .def_rw("gamma", &Hyperparameters::gamma)
      .def_rw("gae_lambda", &Hyperparameters::gae_lambda)
      .def_rw("ent_coef", &Hyperparameters::ent_coef)
      .def_rw("vf_coef", &Hyperparameters::vf_coef)
      .def_rw("max_grad_norm", &Hyperparameters::max_grad_norm)
      .def_rw("target_kl", &Hyperparameters::target_kl)
      .def_rw("normalize_advantage", &Hyperparameters::normalize_advantage)
      .def_rw("normalize", &Hyperparameters::normalize)
      .def_rw("log_std_init", &Hyperparameters::log_std_init)
      .def_rw("ortho_init", &Hyperparameters::ortho_init)
      .def_rw("relu", &Hyperparameters::relu)
      .def_rw("shared", &Hyperparameters::shared)
      .def_rw("pi", &Hyperparameters::pi)
      .def_rw("vf", &Hyperparameters::vf)
      .def_rw("threads", &Hyperparameters::threads)
      .def(
          "choose",
          [](Hyperparameters& h, nb::handle options) { h.setting = setting_of(1, options); },
          nb::arg("options").none(), nb::keep_alive<1, 2>());

  nb::class_<Training>(module, "PolicyGradient")
      .def(nb::init<const std::string&, int, const Hyperparameters&, const std::string&>(),
           nb::arg("problem"), nb::arg("limit"), nb::arg("hyperparameters"),
           nb::arg("instruction_set") = "", nb::keep_alive<1, 4>())
      .def("collect", &Training::collect, nb::call_guard<nb::gil_scoped_release>())
      .def("update", &update, nb::arg("learning_rate"), nb::arg("clip_range"),
           nb::arg("clip_range_vf"))
      .def("loss", &loss, nb::arg("observations"), nb::arg("actions"), nb::arg("log_probs"),
           nb::arg("values"), nb::arg("advantages"), nb::arg("returns"), nb::arg("clip_range"),
           nb::arg("clip_range_vf"))
      .def(
          "step",
          [](Training& t, Vector<const float> gradient, double learning_rate) {
            expect_size(gradient, t.agent.size, "the gradient");
            return t.learner.step(gradient.data(), learning_rate);
          },
          nb::arg("gradient"), nb::arg("learning_rate"))
      .def("forward", &forward, nb::arg("observations"))
      .def("play", &play, nb::arg("seeds"), nb::arg("episodes"))
      .def("state", &state)
      .def("restore", &restore, nb::arg("state"))
      .def_prop_ro("rollout", &rollout)
      .def_prop_ro("episodes", &episodes)
      .def_prop_rw("observed", &observed, &set_observed)
      .def_prop_ro("updates", [](const Training& t) { return t.learner.updates; })
      .def_prop_ro("parts", [](const Training& t) { return parts(t.agent); })
      .def_prop_ro("parameters",
                   [](nb::handle self) {
                     const auto& p = training(self).learner.parameters;
                     return view(self, p.data(), {p.size()});
                   })
      .def_prop_ro("steps", [](const Training& t) {
        return t.experience.steps * static_cast<std::uint64_t>(t.h.n_envs);
      });
}

}  // namespace botschool
