// For isa_symbols.cmake's self test: what a copy of the kernel must not contain.
#include <vector>

template class std::vector<int>;

namespace grelha {

[[gnu::noinline]] inline int shared_function(int x) {
  return x + 1;
}

namespace sse2 {
[[gnu::noinline]] inline int other_copy(int x) {
  return x + 2;
}
}  // namespace sse2

namespace scalar {
[[gnu::noinline]] inline int own(int x) {
  return x + 3;
}
int entry(std::vector<int>& v, int x) {
  v.push_back(own(x));
  return shared_function(x) + sse2::other_copy(x);
}
}  // namespace scalar

}  // namespace grelha
