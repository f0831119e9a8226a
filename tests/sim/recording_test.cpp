// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/recording.hpp"

#include <gtest/gtest.h>

#include "meshing/random.hpp"

namespace sunder {
namespace {

Pose at(double x) {
  return {{x, 0, 0}, {}};
}

// Poses at x = 1000 × (track + 1) + index of the time.
Track track_of(std::uint32_t parent, std::uint32_t number, std::uint32_t first,
               std::uint32_t count) {
  Track track{parent, first, {}};
  for (std::uint32_t i = 0; i < count; ++i)
    track.poses.push_back(at(1000.0 * (number + 1) + first + i));
  return track;
}

// Ten times; track 0 moves at 2 … 6, track 1 leaves it at 4 and moves to 7, track 2 leaves that at
// 5 and moves to 5 only.
Recording sample() {
  Recording recording;
  for (int i = 0; i < 10; ++i) recording.times.push_back(0.1 * i);
  recording.tracks = {track_of(kNoTrack, 0, 2, 5), track_of(0, 1, 4, 4), track_of(1, 2, 5, 1)};
  return recording;
}

TEST(Recording, APoseComesFromTheTrackThatWasFollowedThen) {
  const Recording recording = sample();
  const double expected[3][10] = {{-1, -1, 1002, 1003, 1004, 1005, 1006, 1006, 1006, 1006},
                                  {-1, -1, 1002, 1003, 2004, 2005, 2006, 2007, 2007, 2007},
                                  {-1, -1, 1002, 1003, 2004, 3005, 3005, 3005, 3005, 3005}};
  for (std::uint32_t track = 0; track < 3; ++track)
    for (std::uint32_t i = 0; i < 10; ++i)
      EXPECT_EQ(pose_at(recording, track, i, at(-1)), at(expected[track][i]))
          << "track " << track << " time " << i;
}

TEST(Recording, WhatNeverMovedStandsAndHasNoRange) {
  const Recording recording = sample();
  for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(pose_at(recording, kNoTrack, i, at(7)), at(7));
  const TimeRange range = moving_range(recording, kNoTrack);
  EXPECT_EQ(range.first, range.end);
}

TEST(Recording, TheMovingRangeIsFromTheFirstTracksStartToTheLastPose) {
  const Recording recording = sample();
  const std::uint32_t ends[3] = {7, 8, 6};
  for (std::uint32_t track = 0; track < 3; ++track) {
    const TimeRange range = moving_range(recording, track);
    EXPECT_EQ(range.first, 2u);
    EXPECT_EQ(range.end, ends[track]);
  }
}

// Chains of tracks at random: outside its range nothing changes from time to time.
TEST(Recording, NothingMovesOutsideTheMovingRange) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Recording recording;
    recording.times.resize(60);
    std::uint32_t first = 0;
    for (std::uint32_t t = 0; t < 6; ++t) {
      first += 1 + static_cast<std::uint32_t>(random_bits(seed, 1, t) % 6);
      const auto count = 1 + static_cast<std::uint32_t>(random_bits(seed, 2, t) % 12);
      const auto parent =
          t == 0 ? kNoTrack : static_cast<std::uint32_t>(random_bits(seed, 3, t) % t);
      recording.tracks.push_back(track_of(parent, t, first, count));
    }
    for (std::uint32_t t = 0; t < 6; ++t) {
      const TimeRange range = moving_range(recording, t);
      for (std::uint32_t i = 0; i + 1 < 60; ++i) {
        const Pose here = pose_at(recording, t, i, at(-1));
        const Pose next = pose_at(recording, t, i + 1, at(-1));
        if (i + 1 < range.first || i + 1 >= range.end) {
          EXPECT_EQ(here, next) << "seed " << seed << " track " << t << " time " << i;
        }
        EXPECT_EQ(here == at(-1), i < range.first);
      }
      EXPECT_EQ(pose_at(recording, t, range.end - 1, at(-1)), recording.tracks[t].poses.back());
    }
  }
}

}  // namespace
}  // namespace sunder
