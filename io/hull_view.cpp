// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/hull_view.hpp"

namespace sunder {
namespace {

constexpr std::string_view kUcx = "UCX_", kConvcol = "-convcolonly";

// Takes digits off the end, at least `least`; false if there are fewer.
bool take_digits(std::string_view& name, std::size_t least, std::size_t most) {
  std::size_t count = 0;
  while (!name.empty() && count < most && name.back() >= '0' && name.back() <= '9') {
    name.remove_suffix(1);
    ++count;
  }
  return count >= least;
}

bool take_end(std::string_view& name, std::string_view end) {
  if (!name.ends_with(end)) return false;
  name.remove_suffix(end.size());
  return true;
}

}  // namespace

HullNodes hull_nodes(std::string_view name) {
  return name == "ucx" ? HullNodes::ucx : name == "convcol" ? HullNodes::convcol : HullNodes::none;
}

std::string hull_name(HullNodes nodes, std::string_view chunk, std::uint32_t index) {
  const std::string number = std::string(index < 10 ? "0" : "") + std::to_string(index);
  const std::string name(chunk);
  switch (nodes) {
    case HullNodes::ucx: return std::string(kUcx) + name + '_' + number;
    case HullNodes::convcol: return name + '_' + number + std::string(kConvcol);
    case HullNodes::none: break;
  }
  return name + "_hull_" + number;
}

bool is_hull_name(std::string_view name) {
  if (!take_end(name, kConvcol) && !name.starts_with(kUcx)) return false;
  return take_digits(name, 2, 2) && take_end(name, "_") && take_digits(name, 4, 56) &&
         take_end(name, "_chunk_");
}

}  // namespace sunder
