#include "frontend/jobs/identity.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <sstream>

#include "frontend/files/digest.hpp"
#include "frontend/files/text.hpp"

namespace grelha {
namespace {

constexpr const char* kColored = " colors=light";

/// Digests the length as well; otherwise the end of one array could be the beginning of the next.
template <class T>
void take(Digest& digest, const std::vector<T>& values) {
  const std::uint64_t size = values.size();
  digest.numbers(std::span(&size, 1));
  digest.numbers(std::span<const T>(values));
}

void take(Digest& digest, const Float3& v) {
  const float values[] = {v.x, v.y, v.z};
  digest.numbers(std::span<const float>(values));
}

template <class... T>
void take_all(Digest& digest, const T&... values) {
  (take(digest, values), ...);
}

void take(Digest& digest, const Material& m) {
  take_all(digest, m.diffuse, m.specular, m.mirror, m.emission);
  const float values[] = {m.transmission, m.shine, m.ior, m.fresnel ? 1.f : 0.f, m.roughness};
  digest.numbers(std::span<const float>(values));
}

void take(Digest& digest, const Geometry& g) {
  // objects only order the triangles in memory: no pixel depends on them
  const auto& [s, t, c, p, objects] = g;
  take_all(digest, s.x, s.y, s.z, s.radius, s.material);
  take_all(digest, t.x, t.y, t.z, t.nx, t.ny, t.nz, t.a, t.b, t.c, t.material);
  if (!t.red.empty())
    take_all(digest, t.red, t.green, t.blue);
  take_all(digest,
           c.base_x,
           c.base_y,
           c.base_z,
           c.base_radius,
           c.apex_x,
           c.apex_y,
           c.apex_z,
           c.apex_radius,
           c.material);
  take_all(digest, p.x, p.y, p.z, p.nx, p.ny, p.nz, p.material);
}

template <class Number>
std::string text(Number value) {
  char buffer[32];
  // the shortest that reads back as the same number
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

constexpr std::array<std::string_view, 3> kLimits{"error=", "time=", "samples="};

/// The limits of a picture by error.
std::string limits_text(const RefineOptions& r) {
  std::string words;
  const auto add = [&words](const std::string& word) {
    words += (words.empty() ? "" : " ") + word;
  };
  if (r.error > 0)
    add("error=" + text(r.error));
  if (r.seconds > 0)
    add("time=" + text(r.seconds));
  if (r.samples > 0)
    add("time=samples:" + std::to_string(r.samples));
  if (r.most > 0)
    add("samples=" + std::to_string(r.most));
  return words;
}

/// The number of samples a pixel, or the options that determine it.
std::string samples_text(const RenderOptions& o) {
  if (o.refine.on())
    return limits_text(o.refine);
  const std::string count = "samples=" + std::to_string(o.sampling.samples);
  return o.subdivision.on ? count + " adaptive=" + text(o.subdivision.threshold) + ',' +
                                std::to_string(o.subdivision.depth)
                          : count;
}

}  // namespace

std::string scene_digest(const SceneFile& file) {
  Digest digest;
  take(digest, file.scene.geometry);
  for (const Material& m : file.scene.materials)
    take(digest, m);
  for (const Light& l : file.scene.lights)
    take_all(digest, l.position, l.color, l.edge1, l.edge2);
  take_all(digest, file.scene.background, file.camera.eye, file.camera.at, file.camera.up);
  digest.numbers(std::span(&file.camera.angle_deg, 1));
  if (file.camera.orthographic_height > 0)
    digest.numbers(std::span(&file.camera.orthographic_height, 1));
  return digest.hex();
}

std::string settings_text(const RenderCommand& resolved, const Camera& camera) {
  const RenderOptions& o = resolved.render;
  const SampleOptions& s = o.sampling;
  const Effects& e = resolved.effects;
  std::string words = "version=" GRELHA_VERSION " size=" + std::to_string(camera.width) + 'x' +
                      std::to_string(camera.height) + ' ' + samples_text(o) +
                      " sampler=" + sampler_name(s.sampler) + " seed=" + std::to_string(s.seed) +
                      " depth=" + std::to_string(o.depth) + " min-weight=" + text(o.min_weight);
  if (e.shadows)
    words += std::string(" shadows=") + (e.shadows->hard ? "hard" : text(e.shadows->size));
  if (s.light_rays > 1)
    words += " light-rays=" + std::to_string(s.light_rays);
  if (camera.aperture > 0)
    words += " aperture=" + text(camera.aperture) + " focus=" + text(camera.focus);
  if (e.glossy)
    words +=
        " roughness=" + text(e.glossy->roughness) + " gloss-rays=" + std::to_string(s.glossy_rays);
  if (resolved.transparent)
    words += " transparent";
  return resolved.colored ? words + kColored : words;
}

std::string scene_name(const std::string& path) {
  const std::string picture = default_image(path);
  return printable(picture.substr(0, picture.rfind('.')));
}

bool is_colored(const Identity& identity) {
  return identity.settings.ends_with(kColored);
}

const Note kSoftware{"Software", "grelha " GRELHA_VERSION};

Notes notes_of(const Identity& identity) {
  const std::string& s = identity.settings;
  const std::size_t first = s.find(' ');  // behind the version
  Notes notes{kSoftware};
  if (!identity.name.empty())
    notes.emplace_back("Title", identity.name);
  notes.emplace_back("Scene", "XXH3 " + identity.scene);
  notes.emplace_back("Settings", first == s.npos ? s : s.substr(first + 1));
  return notes;
}

namespace {

using WordList = std::vector<std::string>;

bool has(const WordList& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}
std::string key_of(const std::string& word) {
  return word.substr(0, word.find('=') + 1);
}

WordList keys_of(const WordList& words) {
  WordList keys;
  std::transform(words.begin(), words.end(), std::back_inserter(keys), key_of);
  return keys;
}

/// Lists the words that `here` has and `there` lacks, and the missing keys. The words are
/// untrusted.
std::string own_words(const WordList& here, const WordList& there) {
  constexpr int kMost = 8;
  const WordList keys = keys_of(here);
  std::string own;
  int found = 0;
  const auto add_word = [&](const std::string& word) {
    if (++found <= kMost)
      own += (own.empty() ? "" : " ") + word;
  };
  for (const std::string& w : here)
    if (!has(there, w))
      add_word(printable(w));
  for (const std::string& w : there)
    if (!has(keys, key_of(w)))
      add_word("no " + printable(key_of(w)));
  return found > kMost ? own + " ..." : own;
}

}  // namespace

std::string without_limits(const std::string& settings) {
  std::istringstream in(settings);
  std::string rest;
  for (std::string word; in >> word;)
    if (std::ranges::none_of(kLimits, [&](std::string_view l) { return word.starts_with(l); }))
      rest += word + ' ';
  return rest;
}

std::string difference(const std::string& settings,
                       const std::string& other,
                       const std::string& name) {
  const auto words = [](const std::string& all) {
    std::istringstream in(all);
    return WordList(std::istream_iterator<std::string>(in), {});
  };
  const WordList here = words(settings), there = words(other);
  return own_words(here, there) + ", " + name + " has " + own_words(there, here);
}

}  // namespace grelha
