// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/print_soundness.hpp"

#include <utility>

namespace sunder {

void print_soundness(std::FILE* to, const std::string& name, const Soundness& soundness,
                     const std::string& details) {
  const Soundness& s = soundness;
  std::fprintf(to, "%s: %s\n%s", name.c_str(), s.is_sound() ? "sound" : "NOT SOUND",
               details.c_str());
  const std::pair<const char*, std::uint64_t> faults[] = {
      {"chunks are open", s.open_chunks},
      {"chunks are not manifold", s.nonmanifold_chunks},
      {"chunks are inside out", s.inverted_chunks},
      {"pairs of chunks overlap", s.overlapping_pairs},
      {"chunks cross themselves", s.self_crossing_chunks},
      {"solids' outer faces cross each other", s.crossing_surfaces},
      {"crack triangles have no partner", s.unmatched_faces},
      {"slivers", s.slivers}};
  for (const auto& [what, number] : faults)
    if (number > 0) std::fprintf(to, "  %llu %s\n", static_cast<unsigned long long>(number), what);
  if (s.chunks == 0) std::fprintf(to, "  there are no chunks\n");
  Soundness volume_only;  // is_sound() knows how far off is too far
  volume_only.chunks = 1;
  volume_only.volume = s.volume;
  volume_only.volume_expected = s.volume_expected;
  if (!volume_only.is_sound())
    std::fprintf(to, "  the volume is %.9g m³ instead of %.9g m³\n", s.volume, s.volume_expected);
}

}  // namespace sunder
