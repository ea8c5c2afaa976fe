//! Counts of the pipeline's work, step by step.

/// Counts of the pipeline's work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PaperCounts {
    /// Searched viewpoints.
    pub keyframes: usize,
    /// Candidates whose rays were cast.
    pub viewpoints_evaluated: u64,
    /// Waypoints moved by dynamic following.
    pub followed: usize,
    /// Hidden runs of the start that were led aside.
    pub bridged_runs: usize,
    /// Gradients computed.
    pub gradients: u32,
    /// Steps that were taken back.
    pub steps_taken_back: u32,
    /// Step 1: hidden runs with a new azimuth.
    pub straightened_runs: usize,
    /// Step 2: detours replaced by their chords.
    pub detours_removed: usize,
    /// Step 3: waypoints averaged.
    pub oscillations_averaged: usize,
    /// Steps 4 and 7: corrections of waypoints.
    pub projections: usize,
    /// Step 5: waypoints held back.
    pub spikes_spread: usize,
    /// Step 6: waypoints whose altitude could not be smoothed.
    pub altitudes_kept: usize,
}
