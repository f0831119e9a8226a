// SPDX-License-Identifier: GPL-3.0-or-later
// Displacements of irregular frames against CalculiX 2.20 and its beam element U1. Two of these on
// each other make a member, each bending in one plane: one alone bends wrongly about its second
// axis where members follow each other. They have no torsion constant of their own but take
// Iy + Iz, and so do ours here; neither has shear (k = 1e8). Their forces are not told right.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "meshing/random.hpp"
#include "sim/frame_solver.hpp"
#include "tests/oracle/ccx.hpp"
#include "tests/sim/stocked_frame.hpp"

namespace sunder {
namespace {

constexpr double kG = 9.81, kPi = std::numbers::pi;

struct NodeLoad {
  std::uint32_t node = 0;
  Vec3 force;
};
struct Case {
  Frame frame;
  std::vector<NodeLoad> loads;
};

// ---- the frames ----

Frame finished(Frame frame) {
  for (Section& section : frame.sections) section.it = section.iy + section.iz;
  join(frame);
  EXPECT_EQ(text_of(defects_of(frame)), "");
  return frame;
}

Frame regular_frame(const RegularBuilding& building) {
  Frame frame = stocked_frame();
  add_regular(frame, building);
  return finished(frame);
}

Case set_back() {
  RegularBuilding building = regular(4, 3, 5);
  building.bays_x = {6, 4.5, 7};
  for (const std::size_t storey : {2, 3, 4}) building.storeys[storey].bays_x = {0, 2};
  building.storeys[4].bays_z = {1, 2};
  return {regular_frame(building), {}};
}

Case atrium() {
  RegularBuilding building = regular(4, 4, 3);
  building.bays_z = {5, 8, 5};
  building.without = {"slab_1_1_*", "slab_2_1_2", "beam_x_2_1_2", "slab_0_0_1"};
  return {regular_frame(building), {}};
}

/// A bay without a foot: the post above stands on beams.
Case missing_bay() {
  RegularBuilding building = regular(4, 3, 4);
  building.storeys[0].height = 5;
  building.without = {"post_1_1_0", "post_3_0_0", "slab_2_1_3", "beam_z_3_1_3"};
  return {regular_frame(building), {}};
}

/// Two trusses that lean towards each other, cross beams below and half of them above.
Case bridge() {
  Frame frame = stocked_frame();
  std::vector<std::uint32_t> low[2], high[2];
  const int bays = 6;
  for (int side = 0; side < 2; ++side) {
    const double z = side == 0 ? 0 : 5, lean = side == 0 ? 0.6 : -0.6;
    for (int i = 0; i <= bays; ++i)
      low[side].push_back(add_node(frame, {4.0 * i, 2, z}, i == 0 || i == bays));
    for (int i = 0; i < bays; ++i)
      high[side].push_back(add_node(frame, {4.0 * i + 2, 5 + 0.2 * i * (5 - i), z + lean}));
  }
  int serial = 0;
  const auto bar = [&](std::uint32_t a, std::uint32_t b) {
    add_beam(frame, "bar_" + std::to_string(serial++), a, b);
  };
  for (std::size_t i = 0; i < high[0].size(); ++i) {
    for (const int side : {0, 1}) {
      bar(low[side][i], low[side][i + 1]);
      bar(low[side][i], high[side][i]);
      bar(high[side][i], low[side][i + 1]);
      if (i > 0) bar(high[side][i - 1], high[side][i]);
    }
    if (i > 0) bar(low[0][i], low[1][i]);
    if (i % 2 == 0) bar(high[0][i], high[1][i]);
  }
  return {finished(frame), {{low[0][2], {0, -2e5, 0}}, {high[1][3], {1e4, 0, 3e4}}}};
}

/// A mast with arms, all members turned about their axes.
Case cantilevers() {
  Frame frame = stocked_frame();
  std::uint32_t below = add_node(frame, {0, 0, 0}, true);
  Case result{{}, {}};
  for (int level = 1; level <= 4; ++level) {
    const std::uint32_t node = add_node(frame, {0, 4.0 * level, 0});
    const std::string tail = std::to_string(level);
    add_member(frame, "post" + tail, FrameMember::Kind::post, below, node, 0);
    const double angle = 1.1 * level, reach = 5 - 0.7 * level;
    const Vec3 tip{reach * std::cos(angle), 4.0 * level + 1.5, reach * std::sin(angle)};
    const std::uint32_t middle = add_node(frame, 0.5 * (tip + frame.nodes[node].position));
    const std::uint32_t end = add_node(frame, tip);
    add_beam(frame, "arm" + tail, node, middle);
    add_beam(frame, "tip" + tail, middle, end);
    result.loads.push_back({end, {2e3, -1e4, 3e3}});
    below = node;
  }
  for (std::size_t m = 0; m < frame.members.size(); ++m)
    frame.members[m].roll = 0.2 + 0.45 * static_cast<double>(m);
  result.frame = finished(frame);
  return result;
}

Case wind() {
  RegularBuilding building = regular(3, 2, 6);
  building.storeys[3].bays_x = {0, 1};
  building.storeys[4].bays_x = building.storeys[5].bays_x = {0, 1};
  Case result{regular_frame(building), {}};
  for (std::uint32_t i = 0; i < result.frame.nodes.size(); ++i) {
    const FrameNode& node = result.frame.nodes[i];
    const double height = node.position.y;
    if (!node.support) result.loads.push_back({i, {800 * height, 0, 5e3 - 300 * height}});
  }
  return result;
}

/// No node above the other, no member level, every roll different.
Case crooked() {
  Frame frame = stocked_frame();
  RegularBuilding building = regular(3, 3, 3);
  for (StoreyParams& storey : building.storeys) storey.slab_thickness = 0;
  add_regular(frame, building);
  std::uint64_t drawn = 0;
  const auto draw = [&] { return 2 * random_unit(7, drawn++) - 1; };
  for (FrameNode& node : frame.nodes)
    node.position = node.position + Vec3{draw(), node.support ? 0 : 0.6 * draw(), draw()};
  for (FrameMember& member : frame.members) {
    member.kind = FrameMember::Kind::beam;
    member.roll = kPi * draw();
  }
  Case result{finished(frame), {}};
  for (std::uint32_t i = 0; i < result.frame.nodes.size(); ++i)
    if (!result.frame.nodes[i].support)
      result.loads.push_back({i, {2e4 * draw(), 5e4 * draw(), 2e4 * draw()}});
  return result;
}

// ---- the same for CalculiX ----

Vec3 unit(Vec3 v) {
  return 1 / length(v) * v;
}

/// Direction of the web, by its definition.
Vec3 web_of(const Frame& frame, const FrameMember& member) {
  const Vec3 x = unit(frame.nodes[member.to].position - frame.nodes[member.from].position);
  const Vec3 near = member.kind == FrameMember::Kind::post ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  const Vec3 z = unit(near - dot(near, x) * x);
  return std::cos(member.roll) * z + std::sin(member.roll) * cross(x, z);
}

/// Weight per metre of members, with a quarter of a slab on each of its beams, N/m.
std::vector<double> line_weights(const Frame& frame) {
  std::vector<double> weights;
  for (const FrameMember& m : frame.members)
    weights.push_back(kG * frame.steels[m.steel].density * frame.sections[m.section].area);
  for (const FrameSlab& slab : frame.slabs) {
    const Vec3 corner = frame.nodes[slab.nodes[0]].position;
    const double area = length(cross(frame.nodes[slab.nodes[1]].position - corner,
                                     frame.nodes[slab.nodes[3]].position - corner));
    const double weight = kG * frame.materials[slab.material].density * slab.thickness * area;
    for (const std::uint32_t beam : slab.beams)
      weights[beam] += weight / 4 / frame.length(frame.members[beam]);
  }
  return weights;
}

/// What the nodes carry: half of each member's weight and the moments of its held ends.
std::vector<std::array<double, 6>> node_loads(const Case& it) {
  std::vector<std::array<double, 6>> loads(it.frame.nodes.size());
  const auto add = [&](std::uint32_t node, std::size_t first, Vec3 v) {
    loads[node][first] += v.x, loads[node][first + 1] += v.y, loads[node][first + 2] += v.z;
  };
  const std::vector<double> weights = line_weights(it.frame);
  for (std::size_t m = 0; m < weights.size(); ++m) {
    const FrameMember& member = it.frame.members[m];
    const Vec3 along = it.frame.nodes[member.to].position - it.frame.nodes[member.from].position;
    const Vec3 half{0, -weights[m] * length(along) / 2, 0};
    add(member.from, 0, half);
    add(member.to, 0, half);
    add(member.from, 3, 1.0 / 6 * cross(along, half));
    add(member.to, 3, -1.0 / 6 * cross(along, half));
  }
  for (const NodeLoad& load : it.loads) add(load.node, 0, load.force);
  return loads;
}

void write_bending(std::ostream& out, const std::string& set, std::size_t element,
                   const FrameMember& member, double area, double inertia, Vec3 direction) {
  out << "*ELEMENT,TYPE=U1,ELSET=" << set << "\n"
      << element << "," << member.from + 1 << "," << member.to + 1
      << "\n*BEAM SECTION,ELSET=" << set << ",MATERIAL=STEEL,SECTION=GENERAL\n"
      << area << "," << inertia << ",0.,1e-14,1e8\n"
      << direction.x << "," << direction.y << "," << direction.z << "\n";
}

void write_input(std::ostream& out, const Case& it) {
  out.precision(12);  // a field has 20 characters
  out << "*NODE,NSET=NALL\n";
  for (std::size_t i = 0; i < it.frame.nodes.size(); ++i) {
    const Vec3 p = it.frame.nodes[i].position;
    out << i + 1 << "," << p.x << "," << p.y << "," << p.z << "\n";
  }
  const SteelGrade& steel = it.frame.steels[0];
  out << "*MATERIAL,NAME=STEEL\n*ELASTIC\n"
      << steel.youngs_modulus << "," << steel.poisson_ratio
      << "\n*USER ELEMENT,TYPE=U1,NODES=2,INTEGRATION POINTS=2,MAXDOF=6\n";
  for (std::size_t m = 0; m < it.frame.members.size(); ++m) {
    const FrameMember& member = it.frame.members[m];
    const Section& section = it.frame.sections[member.section];
    const Vec3 x = unit(it.frame.nodes[member.to].position - it.frame.nodes[member.from].position);
    const Vec3 web = web_of(it.frame, member);
    const std::string name = std::to_string(m);
    write_bending(out, "Y" + name, 2 * m + 1, member, section.area / 2, section.iy, web);
    write_bending(out, "Z" + name, 2 * m + 2, member, section.area / 2, section.iz, cross(web, x));
  }
  out << "*BOUNDARY\n";
  for (std::size_t i = 0; i < it.frame.nodes.size(); ++i)
    if (it.frame.nodes[i].support) out << i + 1 << ",1,6\n";
  out << "*STEP\n*STATIC\n*CLOAD\n";
  const auto loads = node_loads(it);
  for (std::size_t i = 0; i < loads.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k)
      if (!it.frame.nodes[i].support && loads[i][k] != 0)
        out << i + 1 << "," << k + 1 << "," << loads[i][k] << "\n";
  out << "*NODE PRINT,NSET=NALL\nU\n*END STEP\n";
}

/// Displacement and rotation of every node, by number.
std::vector<std::array<double, 6>> solve_with_ccx(const Case& it) {
  std::ostringstream input;
  write_input(input, it);
  std::vector<std::array<double, 6>> found;
  std::istringstream results(run_ccx(input.str()));
  for (std::string line; std::getline(results, line);) {
    std::istringstream words(line);
    std::size_t node = 0;
    std::array<double, 6> u{};
    if (!(words >> node >> u[0] >> u[1] >> u[2] >> u[3] >> u[4] >> u[5])) continue;
    EXPECT_EQ(node, found.size() + 1);
    found.push_back(u);
  }
  return found;
}

// ---- the comparison ----

FrameLoads our_loads(const Case& it) {
  FrameLoads loads;
  for (const NodeLoad& load : it.loads) {
    const auto member = std::ranges::find_if(it.frame.members, [&](const FrameMember& m) {
      return m.from == load.node || m.to == load.node;
    });
    loads.contacts.push_back({static_cast<std::uint32_t>(member - it.frame.members.begin()),
                              it.frame.nodes[load.node].position, load.force});
  }
  return loads;
}

struct Maker {
  const char* name;
  Case (*make)();
};
std::ostream& operator<<(std::ostream& out, const Maker& maker) {
  return out << maker.name;
}

class FrameAgainstCalculix : public testing::TestWithParam<Maker> {};

/// 2e-5 of the largest: about what U1 itself is off, and what is left of its seven printed digits.
TEST_P(FrameAgainstCalculix, DisplacesTheSame) {
  const Case it = GetParam().make();
  const std::vector<std::array<double, 6>> theirs = solve_with_ccx(it);
  ASSERT_EQ(theirs.size(), it.frame.nodes.size());
  FrameSolver solver(it.frame, {.shear = false});
  solver.solve(our_loads(it));
  double largest[2] = {}, off[2] = {};
  for (std::uint32_t i = 0; i < theirs.size(); ++i) {
    const auto& u = theirs[i];
    const Vec3 ours[2] = {solver.displacement(i), solver.rotation(i)};
    const Vec3 other[2] = {{u[0], u[1], u[2]}, {u[3], u[4], u[5]}};
    for (const int k : {0, 1}) {
      largest[k] = std::max(largest[k], length(ours[k]));
      off[k] = std::max(off[k], length(ours[k] - other[k]));
    }
  }
  std::ostringstream error;
  error << off[0] / largest[0];
  RecordProperty("displacement_error", error.str());
  EXPECT_GT(largest[0], 1e-4);
  EXPECT_LT(off[0], 2e-5 * largest[0]);
  EXPECT_LT(off[1], 2e-5 * largest[1]);
}

INSTANTIATE_TEST_SUITE_P(Irregular, FrameAgainstCalculix,
                         testing::Values(Maker{"SetBack", &set_back}, Maker{"Atrium", &atrium},
                                         Maker{"MissingBay", &missing_bay},
                                         Maker{"Bridge", &bridge},
                                         Maker{"Cantilevers", &cantilevers}, Maker{"Wind", &wind},
                                         Maker{"Crooked", &crooked}),
                         [](const auto& made) { return made.param.name; });

}  // namespace
}  // namespace sunder
