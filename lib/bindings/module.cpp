#include "bindings.hpp"

namespace botschool {
extern const char* const kSources;  // of a file that sources.cmake writes
}

NB_MODULE(_core, module) {
  module.doc() = "The C++ core of botschool; use botschool.net and botschool.problems.";
  module.attr("sources") = botschool::kSources;  // a line "digest name" for each C++ source
  botschool::bind_evonet(module);
  botschool::bind_arena(module);
  botschool::bind_engine(module);
  botschool::bind_planar(module);
  botschool::bind_spatial(module);
  botschool::bind_linear(module);
  botschool::bind_evolution(module);
  botschool::bind_policy_gradient(module);
}
