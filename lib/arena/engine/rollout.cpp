// What runs the episodes of all problems. Compiled once for each instruction set, like the problems.
#include "rollout.hpp"

BOTSCHOOL_BEGIN

std::size_t workspace(const void* entry, const Layout& layout, const Setting& setting) {
  return Rollout<kLanes>::workspace(*static_cast<const Entry*>(entry), layout, setting);
}

void run(const void* entry, const Layout& layout, const Jobs& jobs, Queue& queue,
         Recorder* recorder, void* memory) {
  Rollout<kLanes>::run(*static_cast<const Entry*>(entry), layout, jobs, queue, recorder, memory);
}

BOTSCHOOL_END
