// SPDX-License-Identifier: GPL-3.0-or-later
// Bullet's shapes and narrowphase (GJK, EPA, face clipping), put together so that contacts are
// exact where they can be: gaps to faces, normals of faces, all corners at once.
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <new>

#include "sim/solid.hpp"

namespace sunder {
namespace {

constexpr double kMargin = 1e-3;      // m by which GJK's solids are smaller, at most
constexpr double kMarginShare = 0.1;  // of the least half-width
constexpr double kFlat = 1 - 5e-7;    // cosine: a normal this close to a face's is the face's
constexpr double kEdge = 1 - 1e-3;    // cosine: further from all faces, edges meet
constexpr double kDeepest = 1e-3;     // m by which clipping may exceed the depth that EPA found
constexpr double kFar = 1e-3;         // m; contacts of a ball further away are followed
constexpr double kArrived = 1e-9;     // m
constexpr int kFollowSteps = 24;

btVector3 bullet(Vec3 v) {
  return {v.x, v.y, v.z};
}
Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
btDbvtVolume volume_of(const WorldBox& extent) {
  return btDbvtVolume::FromMM(bullet(extent.low), bullet(extent.high));
}

// ---- shapes --------------------------------------------------------------------------------

/// A prism in a body's frame. GJK sees it smaller by the margin, which Bullet adds again as a
/// rounding; faces and corners for clipping are the true ones, filled in from the prism instead of
/// being searched for by initializePolyhedralFeatures.
class PrismShape final : public btConvexHullShape {
 public:
  /// `axes`, `centre`: of the body frame, in the design frame.
  PrismShape(const Prism& prism, const Axes& axes, Vec3 centre) {
    const double h = prism.half_thickness;
    const double margin =
        std::min(kMargin, kMarginShare * std::min(h, inner_radius(prism.outline)));
    const auto placed = [&](Vec2 p, double z) {
      return bullet(into(axes, prism.axes * Vec3{p.x, p.y, z} + prism.origin - centre));
    };
    setMargin(margin);
    for (const Vec2 p : inset(prism.outline, margin)) {
      addPoint(placed(p, h - margin), false);
      addPoint(placed(p, margin - h), false);
    }
    recalcLocalAabb();
    m_polyhedron = new (btAlignedAlloc(sizeof(btConvexPolyhedron), 16)) btConvexPolyhedron;
    m_polyhedron->m_vertices.reserve(2 * static_cast<int>(prism.outline.size()));
    for (const double z : {h, -h}) {
      for (const Vec2 p : prism.outline) m_polyhedron->m_vertices.push_back(placed(p, z));
    }
    add_faces(prism, axes);
  }

  const btConvexPolyhedron& solid() const { return *m_polyhedron; }

  WorldBox extent(const btTransform& at) const {
    WorldBox extent;
    for (int i = 0; i < solid().m_vertices.size(); ++i)
      extent.add(ours(at * solid().m_vertices[i]));
    return extent;
  }

 private:
  void add_faces(const Prism& prism, const Axes& axes) {
    const int n = static_cast<int>(prism.outline.size());
    m_polyhedron->m_faces.resize(n + 2);
    for (int i = 0; i < n; ++i) {
      const int j = (i + 1) % n;
      const Vec2 side = prism.outline[j] - prism.outline[i];
      const Vec2 out = (1 / length(side)) * Vec2{side.y, -side.x};
      const int corners[] = {n + i, n + j, j, i};
      set_face(i, corners, into(axes, prism.axes * Vec3{out.x, out.y, 0}));
    }
    std::vector<int> top(n), bottom(n);
    for (int i = 0; i < n; ++i) top[i] = i, bottom[i] = 2 * n - 1 - i;
    set_face(n, top, into(axes, prism.axes.z));
    set_face(n + 1, bottom, into(axes, -1.0 * prism.axes.z));
  }

  void set_face(int number, std::span<const int> corners, Vec3 normal) {
    btFace& face = m_polyhedron->m_faces[number];
    face.m_indices.reserve(static_cast<int>(corners.size()));
    for (const int corner : corners) face.m_indices.push_back(corner);
    face.m_plane[0] = normal.x;
    face.m_plane[1] = normal.y;
    face.m_plane[2] = normal.z;
    face.m_plane[3] = -bullet(normal).dot(m_polyhedron->m_vertices[corners[0]]);
  }
};

// ---- narrowphase ---------------------------------------------------------------------------

/// Collects what the narrowphase reports, all of it: a btPersistentManifold would keep points of
/// earlier steps and merge points nearer than its threshold.
class PointCollector final : public btManifoldResult {
 public:
  PointCollector(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                 double margin, std::vector<TouchPoint>& found)
      : btManifoldResult(a, b), found_(found) {
    m_closestPointDistanceThreshold = margin;
  }
  void addContactPoint(const btVector3& normal, const btVector3& point, btScalar gap) override {
    if (!(gap <= m_closestPointDistanceThreshold)) return;
    const Vec3 middle = ours(origin + point + normal * (gap / 2));
    found_.push_back({middle, ours(flipped ? -normal : normal), gap});
  }

  btVector3 origin{0, 0, 0};  ///< what the narrowphase takes for the origin
  bool flipped = false;       ///< the narrowphase has the two the other way round

 private:
  std::vector<TouchPoint>& found_;
};

/// Base of our collision algorithms: they own no manifold.
class OwnAlgorithm : public btCollisionAlgorithm {
 public:
  using btCollisionAlgorithm::btCollisionAlgorithm;
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray&) override {}
};

/// How the faces lie to a direction: the best aligned face and the cosine.
struct Alignment {
  double cosine = -2;
  btVector3 normal;  ///< world
};
Alignment align(const PrismShape& shape, const btTransform& at, const btVector3& direction) {
  const btVector3 local = direction * at.getBasis();
  Alignment best;
  const auto& faces = shape.solid().m_faces;
  int face = 0;
  for (int i = 0; i < faces.size(); ++i) {
    const btScalar* p = faces[i].m_plane;
    const double cosine = p[0] * local.x() + p[1] * local.y() + p[2] * local.z();
    if (cosine > best.cosine) best.cosine = cosine, face = i;
  }
  const btScalar* p = faces[face].m_plane;
  best.normal = at.getBasis() * btVector3(p[0], p[1], p[2]);
  return best;
}

/// True if a face of a is further than margin from all of b: spares most pairs the GJK.
bool is_apart(const PrismShape& a, const btTransform& at_a, const PrismShape& b,
              const btTransform& at_b, double margin) {
  const btTransform into_a = at_a.inverseTimes(at_b);
  std::array<btVector3, 32> corners;
  const auto& of_b = b.solid().m_vertices;
  if (of_b.size() > static_cast<int>(corners.size())) return false;
  for (int i = 0; i < of_b.size(); ++i) corners[i] = into_a * of_b[i];
  for (int f = 0; f < a.solid().m_faces.size(); ++f) {
    const btScalar* p = a.solid().m_faces[f].m_plane;
    double least = BT_LARGE_FLOAT;
    for (int i = 0; i < of_b.size(); ++i) {
      const btVector3& c = corners[i];
      least = std::min(least, p[0] * c.x() + p[1] * c.y() + p[2] * c.z() + p[3]);
      if (least <= margin) break;
    }
    if (least > margin) return true;
  }
  return false;
}

/// Prism against prism: btConvexConvexAlgorithm's way (GJK, or EPA if they overlap, for the normal;
/// then the faces are clipped against each other), with three differences. The normal of a face
/// contact is the face's own; the clipping is against whichever face is better aligned, so that
/// gaps are exact; where edges meet, GJK's own point is added.
class PrismAlgorithm final : public OwnAlgorithm {
 public:
  using OwnAlgorithm::OwnAlgorithm;
  void processCollision(const btCollisionObjectWrapper* wrap_a,
                        const btCollisionObjectWrapper* wrap_b, const btDispatcherInfo&,
                        btManifoldResult* result) override {
    const auto& a = static_cast<const PrismShape&>(*wrap_a->getCollisionShape());
    const auto& b = static_cast<const PrismShape&>(*wrap_b->getCollisionShape());
    auto& collector = static_cast<PointCollector&>(*result);
    const double margin = result->m_closestPointDistanceThreshold;
    btGjkPairDetector::ClosestPointInput input;
    collector.origin = wrap_b->getWorldTransform().getOrigin();
    input.m_transformA = wrap_a->getWorldTransform();
    input.m_transformB = wrap_b->getWorldTransform();
    input.m_transformA.getOrigin() -= collector.origin;
    input.m_transformB.getOrigin().setZero();
    if (is_apart(a, input.m_transformA, b, input.m_transformB, margin) ||
        is_apart(b, input.m_transformB, a, input.m_transformA, margin)) {
      return;
    }
    const double reach = a.getMargin() + b.getMargin() + margin;
    input.m_maximumDistanceSquared = reach * reach;
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver epa;
    btGjkPairDetector gjk(&a, &b, &simplex, &epa);
    btPointCollector closest;
    gjk.getClosestPoints(input, closest, nullptr);
    if (closest.m_hasResult && closest.m_distance <= margin) clip(a, b, input, closest, collector);
  }

 private:
  static void clip(const PrismShape& a, const PrismShape& b,
                   const btGjkPairDetector::ClosestPointInput& input,
                   const btPointCollector& closest, PointCollector& collector) {
    const btTransform& at_a = input.m_transformA;
    const btTransform& at_b = input.m_transformB;
    btVector3 normal = closest.m_normalOnBInWorld;  // from b to a
    const Alignment on_a = align(a, at_a, -normal), on_b = align(b, at_b, normal);
    const bool b_leads = on_b.cosine > on_a.cosine + 1e-6;
    const double cosine = std::max(on_a.cosine, on_b.cosine);
    if (cosine > kFlat) normal = b_leads ? on_b.normal : -on_a.normal;
    if (cosine < kEdge) {
      collector.addContactPoint(normal, closest.m_pointInWorld, closest.m_distance);
    }
    const double least = std::min(closest.m_distance, 0.0) - kDeepest;
    const double most = collector.m_closestPointDistanceThreshold;
    btVertexArray scratch, clipped;
    if (b_leads) {
      collector.flipped = true;
      btPolyhedralContactClipping::clipHullAgainstHull(-normal, b.solid(), a.solid(), at_b, at_a,
                                                       least, most, scratch, clipped, collector);
    } else {
      btPolyhedralContactClipping::clipHullAgainstHull(normal, a.solid(), b.solid(), at_a, at_b,
                                                       least, most, scratch, clipped, collector);
    }
  }
};

/// Prism against plane, with all its corners at once; Bullet's own finds one per step.
class GroundAlgorithm final : public OwnAlgorithm {
 public:
  using OwnAlgorithm::OwnAlgorithm;
  void processCollision(const btCollisionObjectWrapper* prism,
                        const btCollisionObjectWrapper* ground, const btDispatcherInfo&,
                        btManifoldResult* result) override {
    const auto& shape = static_cast<const PrismShape&>(*prism->getCollisionShape());
    const auto& plane = static_cast<const btStaticPlaneShape&>(*ground->getCollisionShape());
    const btTransform& at = prism->getWorldTransform();
    const btVector3 normal = ground->getWorldTransform().getBasis() * plane.getPlaneNormal();
    for (int i = 0; i < shape.solid().m_vertices.size(); ++i) {
      const btVector3 corner = at * shape.solid().m_vertices[i];
      const double gap = normal.dot(corner - ground->getWorldTransform().getOrigin());
      result->addContactPoint(normal, corner - normal * gap, gap);
    }
  }
};

template <typename Algorithm>
struct Create final : btCollisionAlgorithmCreateFunc {
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper*,
                                                 const btCollisionObjectWrapper*) override {
    return new (info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm))) Algorithm(info);
  }
};

}  // namespace

void WorldBox::add(Vec3 p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}
void WorldBox::grow(double by) {
  low = low - Vec3{by, by, by};
  high = high + Vec3{by, by, by};
}
bool overlap(const WorldBox& a, const WorldBox& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

struct Solid::Impl {
  double radius = 0, reach = 0;
  std::vector<std::unique_ptr<PrismShape>> parts;
  std::unique_ptr<btCollisionShape> whole;  ///< null: the only part

  btCollisionShape* part(std::uint32_t number) const {
    return parts.empty() ? whole.get() : parts[number].get();
  }
};

Solid::Solid() : impl_(std::make_unique<Impl>()) {
  impl_->whole = std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), 0);
}

Solid::Solid(double radius) : impl_(std::make_unique<Impl>()) {
  impl_->radius = impl_->reach = radius;
  impl_->whole = std::make_unique<btSphereShape>(radius);
}

Solid::Solid(std::span<const Prism> prisms, const Axes& axes, Vec3 centre)
    : impl_(std::make_unique<Impl>()) {
  assert(!prisms.empty() && "a body has a solid");
  impl_->parts.reserve(prisms.size());
  for (const Prism& prism : prisms) {
    impl_->parts.push_back(std::make_unique<PrismShape>(prism, axes, centre));
    const btConvexPolyhedron& solid = impl_->parts.back()->solid();
    for (int i = 0; i < solid.m_vertices.size(); ++i) {
      impl_->reach = std::max(impl_->reach, solid.m_vertices[i].length());
    }
  }
  if (prisms.size() == 1) return;
  auto compound = std::make_unique<btCompoundShape>(true, static_cast<int>(prisms.size()));
  for (const auto& part : impl_->parts) {
    compound->addChildShape(btTransform::getIdentity(), part.get());
  }
  impl_->whole = std::move(compound);
}

Solid::Solid(Solid&&) noexcept = default;
Solid::~Solid() = default;

bool Solid::is_half_space() const {
  return impl_->parts.empty() && impl_->radius == 0;
}
double Solid::radius() const {
  return impl_->radius;
}
double Solid::reach() const {
  return impl_->reach;
}
btCollisionShape& Solid::shape() const {
  return impl_->whole ? *impl_->whole : *impl_->parts[0];
}

WorldBox Solid::extent(const btTransform& at) const {
  WorldBox extent;
  if (impl_->radius > 0) {
    extent.add(ours(at.getOrigin()));
    extent.grow(impl_->radius);
  }
  for (const auto& part : impl_->parts) {
    const WorldBox one = part->extent(at);
    extent.add(one.low);
    extent.add(one.high);
  }
  return extent;
}

WorldBox Solid::rough_extent(const btTransform& at) const {
  if (impl_->parts.size() <= 1) return extent(at);
  btVector3 low, high;
  impl_->whole->getAabb(at, low, high);
  return {ours(low), ours(high)};
}

// ---- pairs of solids -----------------------------------------------------------------------

/// A solid in its place.
struct Placed {
  const Solid::Impl* solid = nullptr;
  btTransform at;
};

struct Toucher::Impl {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  Create<PrismAlgorithm> prisms;
  Create<GroundAlgorithm> ground;
  btCollisionObject nobody;
  btPersistentManifold* scratch = nullptr;
  btDispatcherInfo info;
  btNodeStack stack;
  std::vector<TouchPoint> touches;

  template <typename Visit>
  void for_near_parts(const Placed& a, const Placed& b, double margin, Visit&& visit);
  void find_near_parts(const Placed& few, std::uint32_t part, const Placed& many, double margin,
                       std::vector<std::uint32_t>& near);
  void touch(const Placed& a, std::uint32_t i, const Placed& b, std::uint32_t j, double margin);
  void follow(Placed a, std::uint32_t i, const Placed& b, std::uint32_t j,
              const RelativePath& path);
};

/// Calls `visit(i, j)` for parts whose boxes are nearer than margin, in ascending order.
template <typename Visit>
void Toucher::Impl::for_near_parts(const Placed& a, const Placed& b, double margin, Visit&& visit) {
  const std::size_t count_a = a.solid->parts.size(), count_b = b.solid->parts.size();
  if (count_a <= 1 && count_b <= 1) return visit(0u, 0u);
  const bool swapped = count_a > count_b;
  const Placed& few = swapped ? b : a;
  const Placed& many = swapped ? a : b;
  std::vector<std::uint32_t> near;
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::uint32_t i = 0; i < std::max<std::size_t>(1, few.solid->parts.size()); ++i) {
    find_near_parts(few, i, many, margin, near);
    for (const std::uint32_t j : near) {
      pairs.push_back(swapped ? std::array{j, i} : std::array{i, j});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [i, j] : pairs) visit(i, j);
}

/// Fills `near` with the parts of `many` that may be near a part of `few`.
void Toucher::Impl::find_near_parts(const Placed& few, std::uint32_t part, const Placed& many,
                                    double margin, std::vector<std::uint32_t>& near) {
  near.clear();
  struct Collect final : btDbvt::ICollide {
    std::vector<std::uint32_t>* parts = nullptr;
    void Process(const btDbvtNode* leaf) override {
      parts->push_back(static_cast<std::uint32_t>(leaf->dataAsInt));
    }
  } collect;
  collect.parts = &near;
  const btTransform into_many = many.at.inverseTimes(few.at);
  const bool is_ball = few.solid->radius > 0;
  if (!is_ball && few.solid->parts.empty()) {  // the half-space
    for (std::uint32_t j = 0; j < many.solid->parts.size(); ++j) near.push_back(j);
    return;
  }
  WorldBox box;
  if (is_ball) {
    box.add(ours(into_many.getOrigin()));
    box.grow(few.solid->radius);
  } else {
    box = few.solid->parts[part]->extent(into_many);
  }
  box.grow(margin);
  const btDbvt& tree =
      *static_cast<const btCompoundShape&>(*many.solid->whole).getDynamicAabbTree();
  tree.collideTVNoStackAlloc(tree.m_root, volume_of(box), stack, collect);
}

/// Fills `touches`, normals from b to a. Bullet gets the prism before the ball before the ground.
void Toucher::Impl::touch(const Placed& a, std::uint32_t i, const Placed& b, std::uint32_t j,
                          double margin) {
  touches.clear();
  const btCollisionObjectWrapper wrap_a(nullptr, a.solid->part(i), &nobody, a.at, -1, -1);
  const btCollisionObjectWrapper wrap_b(nullptr, b.solid->part(j), &nobody, b.at, -1, -1);
  const bool flipped = a.solid->parts.empty() && (a.solid->radius == 0 || !b.solid->parts.empty());
  const btCollisionObjectWrapper* first = flipped ? &wrap_b : &wrap_a;
  const btCollisionObjectWrapper* second = flipped ? &wrap_a : &wrap_b;
  PointCollector collector(first, second, margin, touches);
  btCollisionAlgorithm* algorithm =
      dispatcher.findAlgorithm(first, second, scratch, BT_CLOSEST_POINT_ALGORITHMS);
  algorithm->processCollision(first, second, info, &collector);
  algorithm->~btCollisionAlgorithm();
  dispatcher.freeCollisionAlgorithm(algorithm);
  if (!flipped) return;
  for (TouchPoint& point : touches) point.normal = -1.0 * point.normal;
}

/// Conservative advancement (Mirtich 1996) of a on its path, until it is at b; `touches` holds the
/// contact now, and then that of the arrival as seen from now, or none if it misses. While the gap
/// is above 0, the plane between the two has to be crossed first, so no step goes too far.
void Toucher::Impl::follow(Placed a, std::uint32_t i, const Placed& b, std::uint32_t j,
                           const RelativePath& path) {
  const btVector3 start = a.at.getOrigin();
  const double first_gap = touches[0].gap;
  double time = 0;
  for (int step = 0; step < kFollowSteps && !touches.empty(); ++step) {
    const TouchPoint now = touches[0];
    const Vec3 gone = time * path.velocity + (time * time / 2) * path.acceleration;
    if (now.gap <= kArrived * (1 + first_gap) || step == kFollowSteps - 1) {
      // On a ball it is where it will be on it.
      const double share = a.solid->radius == 0 ? 0 : (b.solid->radius == 0 ? 1 : 0.5);
      touches = {{now.at - share * gone, now.normal, now.gap - dot(now.normal, gone)}};
      return;
    }
    const double closing = -dot(now.normal, path.velocity + time * path.acceleration);
    const double pull = -dot(now.normal, path.acceleration);
    const double squared = closing * closing + 2 * pull * now.gap;
    const double sum = squared < 0 ? 0 : closing + std::sqrt(squared);
    if (!(sum > 0)) break;
    time += 2 * now.gap / sum;
    if (!(time < path.duration)) break;
    a.at.setOrigin(start + bullet(time * path.velocity + (time * time / 2) * path.acceleration));
    touch(a, i, b, j, 2 * first_gap + kFar);
  }
  touches.clear();
}

Toucher::Toucher() : impl_(std::make_unique<Impl>()) {
  constexpr int kHull = CONVEX_HULL_SHAPE_PROXYTYPE;
  btCollisionDispatcher& dispatcher = impl_->dispatcher;
  dispatcher.registerClosestPointsCreateFunc(kHull, kHull, &impl_->prisms);
  dispatcher.registerClosestPointsCreateFunc(kHull, STATIC_PLANE_PROXYTYPE, &impl_->ground);
  dispatcher.setDispatcherFlags(0);
  impl_->scratch = dispatcher.getNewManifold(&impl_->nobody, &impl_->nobody);
  impl_->scratch->setContactBreakingThreshold(0);
}
Toucher::~Toucher() {
  impl_->dispatcher.releaseManifold(impl_->scratch);
}
btCollisionDispatcher& Toucher::dispatcher() {
  return impl_->dispatcher;
}

void Toucher::find(const Solid& a, const btTransform& at_a, const Solid& b, const btTransform& at_b,
                   double margin, const RelativePath& path, std::vector<PartTouch>& found) {
  const Placed placed_a{a.impl_.get(), at_a}, placed_b{b.impl_.get(), at_b};
  const bool is_round =
      (a.radius() > 0 || b.radius() > 0) && !a.is_half_space() && path.duration > 0;
  impl_->for_near_parts(placed_a, placed_b, margin, [&](std::uint32_t i, std::uint32_t j) {
    impl_->touch(placed_a, i, placed_b, j, margin);
    if (is_round && !impl_->touches.empty() && impl_->touches[0].gap > kFar) {
      impl_->follow(placed_a, i, placed_b, j, path);
    }
    keep_four(impl_->touches);
    for (const TouchPoint& point : impl_->touches) found.push_back({i, j, point});
  });
}

}  // namespace sunder
