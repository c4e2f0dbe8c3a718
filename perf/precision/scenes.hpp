#pragma once

namespace grelha::perf {

/// Traces whole scenes, by every copy of the kernel in single and double precision, and by Embree.
int run_scenes(int groups);

}  // namespace grelha::perf
