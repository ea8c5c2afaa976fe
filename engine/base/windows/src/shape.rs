//! The sliding-window sampler (paper, section "Dual-Trajectory Augmentation").

use serde::Serialize;

/// Shape of training windows. A window is `history` frames of the perturbed flight, the input of a model, and `horizon`
/// frames after them; the expert's frames of the whole window are the supervision: the first ones for denoising, the
/// others for prediction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct WindowShape {
    /// Number of input frames; the last one is the current frame.
    pub history: usize,
    /// Number of waypoints to predict.
    pub horizon: usize,
    /// Number of frames from the start of a window to the start of the next one.
    pub stride: usize,
}

impl Default for WindowShape {
    /// The paper's shape: size 10, the first 5 as input, stride 3.
    fn default() -> Self {
        Self { history: 5, horizon: 5, stride: 3 }
    }
}

impl WindowShape {
    /// Number of frames of a window.
    pub fn size(&self) -> usize {
        self.history + self.horizon
    }

    /// Whether the shape is valid: at least one frame on both sides, and a stride of at least 1.
    pub fn is_possible(&self) -> bool {
        self.history > 0 && self.horizon > 0 && self.stride > 0
    }

    /// Number of windows in a flight of `frames` frames.
    pub fn count(&self, frames: usize) -> usize {
        if !self.is_possible() || frames < self.size() { 0 } else { (frames - self.size()) / self.stride + 1 }
    }

    /// First frames of the windows of a flight of `frames` frames, in order. Windows never exceed its end.
    pub fn starts(&self, frames: usize) -> impl Iterator<Item = usize> + use<> {
        let stride = self.stride;
        (0..self.count(frames)).map(move |window| window * stride)
    }

    /// Index of the window that starts at frame `start` of a flight of `frames` frames.
    pub fn number(&self, start: usize, frames: usize) -> Option<usize> {
        let stride = self.stride.max(1);
        (start.is_multiple_of(stride) && start / stride < self.count(frames)).then_some(start / stride)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_start_every_three_frames_and_stay_inside() {
        let shape = WindowShape::default();
        for (frames, expected) in [(0, vec![]), (9, vec![]), (10, vec![0]), (12, vec![0]), (16, vec![0, 3, 6])] {
            assert_eq!(shape.starts(frames).collect::<Vec<_>>(), expected, "{frames}");
        }
        assert_eq!(shape.count(200), 64);
    }

    #[test]
    fn only_starts_of_windows_have_a_number() {
        let shape = WindowShape::default();
        assert_eq!(shape.number(6, 16), Some(2));
        assert_eq!((shape.number(5, 16), shape.number(9, 16)), (None, None));
        assert_eq!(WindowShape { stride: 0, ..shape }.count(100), 0);
    }
}
