// The hyperparameters of a policy network, each in one line: the C++ Spec and its checks, the keys of
// [POLICY] in experiment files and botschool.net.NetworkSpec are all made from it.
//   X(type, name, default, least, greatest, explanation, "value: meaning | ..." or "")
#pragma once

// clang-format off
#define BOTSCHOOL_HYPERPARAMETERS(X) \
  X(int, nhiddens, 50, 0, 10000, "hidden neurons per layer (0 = inputs go straight to outputs)", "") \
  X(int, nhiddens2, 0, 0, 20000, "neurons of the second of two layers, the first gets the others (0 = equal layers)", "") \
  X(int, nlayers, 1, 1, 16, "hidden layers; recurrent networks have one", "") \
  X(int, bias, 0, 0, 1, "hidden and output neurons have a bias", "0: no | 1: yes") \
  X(int, out_type, 2, 1, 5, "activation of outputs", "1: logistic | 2: tanh | 3: linear | 4: binary | 5: relu") \
  X(int, nbins, 1, 1, 1000, "output neurons per actuator; from 2 on the strongest picks the action", "") \
  X(int, architecture, 0, 0, 4, "wiring of the network", "0: feed-forward | 1: recurrent | 2: fully recurrent | 3: LSTM | 4: convolutional") \
  X(int, afunction, 2, 1, 5, "activation of hidden neurons", "1: logistic | 2: tanh | 3: linear | 5: relu") \
  X(int, winit, 0, 0, 2, "initial weights", "0: Xavier | 1: norm-incoming | 2: uniform") \
  X(int, action_noise, 0, 0, 2, "noise added to actions", "0: none | 1: Gaussian | 2: Gaussian, evolved size") \
  X(double, action_noise_range, 0.01, 0, 1000, "standard deviation of the noise when action_noise = 1", "") \
  X(int, normalize, 0, 0, 1, "observations are scaled to mean 0 and spread 1", "0: no | 1: yes") \
  X(int, clip, 0, 0, 1, "inputs are kept within -5 to 5, scaled or not", "0: no | 1: yes") \
  X(double, wrange, 1.0, 0, 1000, "initial weights lie within -wrange to wrange when winit = 2", "")
// clang-format on
