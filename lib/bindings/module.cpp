#include "bindings.hpp"

NB_MODULE(_core, module) {
  module.doc() = "The C++ core of botschool; use botschool.net and botschool.problems.";
  botschool::bind_evonet(module);
  botschool::bind_arena(module);
  botschool::bind_engine(module);
  botschool::bind_planar(module);
  botschool::bind_linear(module);
}
