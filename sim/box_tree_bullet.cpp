// SPDX-License-Identifier: GPL-3.0-or-later
#include <bullet/BulletCollision/BroadphaseCollision/btDbvt.h>

#include "sim/box_tree.hpp"

namespace sunder {
namespace {

btVector3 bullet_vector(Vec3 v) {
  return {v.x, v.y, v.z};
}

btDbvtVolume volume_of(const Box3& box) {
  return btDbvtVolume::FromMM(bullet_vector(box.low), bullet_vector(box.high));
}

struct Collect : btDbvt::ICollide {
  std::vector<std::uint32_t>* found = nullptr;
  void Process(const btDbvtNode* leaf) override {
    found->push_back(static_cast<std::uint32_t>(leaf->dataAsInt));
  }
};

}  // namespace

struct BoxTree::Impl {
  btDbvt tree;
  mutable btNodeStack stack;
};

BoxTree::BoxTree() : impl_(std::make_unique<Impl>()) {}
BoxTree::~BoxTree() = default;

BoxTree::Leaf BoxTree::insert(const Box3& box, std::uint32_t number) {
  btDbvtNode* leaf = impl_->tree.insert(volume_of(box), nullptr);
  leaf->dataAsInt = static_cast<int>(number);
  return leaf;
}

void BoxTree::remove(Leaf leaf) {
  impl_->tree.remove(static_cast<btDbvtNode*>(leaf));
}

void BoxTree::update(Leaf leaf, const Box3& box, double slack) {
  auto* node = static_cast<btDbvtNode*>(leaf);
  if (node->volume.Contain(volume_of(box))) return;
  btDbvtVolume fat = volume_of(grown(box, slack));
  impl_->tree.update(node, fat);
}

void BoxTree::find(const Box3& box, std::vector<std::uint32_t>& found) const {
  if (impl_->tree.m_root == nullptr) return;
  Collect collect;
  collect.found = &found;
  impl_->tree.collideTVNoStackAlloc(impl_->tree.m_root, volume_of(box), impl_->stack, collect);
}

}  // namespace sunder
