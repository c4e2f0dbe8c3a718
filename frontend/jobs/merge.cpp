#include "frontend/jobs/merge.hpp"

#include <algorithm>
#include <optional>

#include "frontend/commands/commands.hpp"

namespace grelha {
namespace {

Range common(const Range& a, const Range& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}
bool empty(const Range& r) {
  return r.begin >= r.end;
}
void extend(Range& r, const Range& by) {
  r = {std::min(r.begin, by.begin), std::max(r.end, by.end)};
}

/// Returns the first samples in `wanted` that no part has for row `y`.
Range missing_of_row(const std::vector<Part>& parts, const Range& wanted, int y) {
  std::vector<Range> here;
  for (const Part& p : parts)
    if (p.rows.begin <= y && y < p.rows.end)
      here.push_back(p.samples);
  std::sort(
      here.begin(), here.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
  int at = wanted.begin;
  for (const Range& r : here) {
    if (r.begin > at)
      return {at, r.begin};
    at = r.end;
  }
  return {at, wanted.end};
}

/// Returns the first missing part of `whole`. Rows change only where a part begins or ends.
std::optional<Part> first_gap(const std::vector<Part>& parts, const Part& whole) {
  std::vector<int> cuts{whole.rows.end};
  for (const Part& p : parts) {
    cuts.push_back(p.rows.begin);
    cuts.push_back(p.rows.end);
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  std::optional<Part> gap;
  int y = whole.rows.begin;
  for (const int cut : cuts) {
    if (cut <= y)
      continue;
    const Range samples = missing_of_row(parts, whole.samples, y);
    if (gap && samples != gap->samples)
      break;
    if (gap)
      gap->rows.end = cut;
    else if (!empty(samples))
      gap = Part{{y, cut}, samples};
    y = cut;
  }
  return gap;
}

std::string percent(double share) {
  return std::to_string(int(share * 100)) + " %";
}

/// Reads every file twice, and allocates the sums only after checking that the parts fill them. So
/// a small file which claims to be of a huge picture takes only a small file's memory.
class Joiner {
 public:
  explicit Joiner(const std::vector<std::string>& files) : files_(files) {}

  Partial run() {
    for (const std::string& file : files_)
      look_at(file, read_partial(file));
    Part whole = parts_.front();
    for (const Part& p : parts_) {
      extend(whole.rows, p.rows);
      extend(whole.samples, p.samples);
    }
    if (const auto gap = first_gap(parts_, whole))
      throw UsageError("no part has " + part_text(*gap));
    begin(whole);
    for (std::size_t i = 0; i < files_.size(); ++i)
      take(files_[i], read_partial(files_[i]), parts_[i]);
    return std::move(joined_);
  }

 private:
  void look_at(const std::string& file, const Partial& p) {
    const Accumulator& a = p.sums;
    if (parts_.empty())
      joined_ = {p.identity, {a.width, a.height, a.samples, {}, {}, {}}};
    else
      check_same(file, p);
    if (!is_complete(a))
      throw UsageError(file + " is not finished, " + percent(share_done(a)) +
                       " are done: the command that made it goes on");
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Part both{common(a.part.rows, parts_[i].rows),
                      common(a.part.samples, parts_[i].samples)};
      if (!empty(both.rows) && !empty(both.samples))
        throw UsageError(file + " and " + files_[i] + " both have " + part_text(both));
    }
    parts_.push_back(a.part);
  }

  void check_same(const std::string& file, const Partial& p) const {
    const Identity& identity = p.identity;
    const Accumulator &a = p.sums, &first = joined_.sums;
    if (identity.scene != joined_.identity.scene)
      throw UsageError(file + " is of another scene than " + files_.front());
    if (identity.settings != joined_.identity.settings)
      throw UsageError(file + " has " +
                       difference(identity.settings, joined_.identity.settings, files_.front()));
    // whatever the settings claim
    if (a.width != first.width || a.height != first.height || a.samples != first.samples)
      throw UsageError(file + " is of a picture of another size than " + files_.front());
  }

  void begin(const Part& whole) {
    Accumulator& a = joined_.sums;
    a.part = whole;
    a.sums.resize(std::size_t(whole.rows.end - whole.rows.begin) * std::size_t(a.width) * 3);
    a.done.assign(piece_count(whole), 1);
  }

  void take(const std::string& file, const Partial& p, const Part& part) {
    check_same(file, p);
    if (p.sums.part != part || !is_complete(p.sums))
      throw UsageError(file + " was changed while it was read");
    add(joined_.sums, p.sums);
  }

  const std::vector<std::string>& files_;
  std::vector<Part> parts_;  ///< of files_, those looked at
  Partial joined_;
};

}  // namespace

Partial merge_parts(const std::vector<std::string>& files) {
  return Joiner(files).run();
}

}  // namespace grelha
