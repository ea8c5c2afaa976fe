//! All counts of tracked sequences, and the reported scores.

use super::clear::ClearTally;
use super::frame::TrackedFrame;
use super::hota::HotaTally;
use super::identity::IdentityTally;

/// Counts of sequences, which add up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackTally {
    /// Behind HOTA, DetA and AssA.
    pub hota: HotaTally,
    /// Behind IDF1.
    pub identity: IdentityTally,
    /// Behind MOTA.
    pub clear: ClearTally,
}

impl TrackTally {
    /// Counts of a sequence.
    pub fn of(frames: &[TrackedFrame]) -> Self {
        Self { hota: HotaTally::of(frames), identity: IdentityTally::of(frames), clear: ClearTally::of(frames) }
    }

    /// Adds other counts `times` times.
    pub fn add_times(&mut self, other: &Self, times: f64) {
        self.hota.add_times(&other.hota, times);
        self.identity.add_times(&other.identity, times);
        self.clear.add_times(&other.clear, times);
    }

    /// The scores, in the order of [`OF_TRACKS`](crate::scores::OF_TRACKS); `None` without true boxes.
    pub fn scores(&self) -> Option<[f64; 5]> {
        let hota = self.hota.scores();
        let scores = [hota.hota, hota.detection, hota.association, self.identity.f1(), self.clear.accuracy()];
        (self.identity.truth > 0.0).then_some(scores)
    }
}
