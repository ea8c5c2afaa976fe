//! Frames of a flight that a teacher sees.

use crate::config::TeacherFrames;

/// Number of pictures over a whole flight, and of a clip.
const KEYFRAMES: usize = 4;
const CLIP: usize = 8;
/// Time between the pictures of a clip, seconds.
const CLIP_STEP_S: f64 = 1.0;

impl TeacherFrames {
    /// Number of pictures of a question.
    pub fn count(self) -> u64 {
        match self {
            Self::None => 0,
            Self::Keyframes => KEYFRAMES as u64,
            Self::Clip => CLIP as u64,
        }
    }

    /// Numbers of the frames to show, each once, of a flight of `all` frames.
    pub fn chosen(self, all: usize, dt_s: f64) -> Vec<usize> {
        let mut chosen: Vec<usize> = match self {
            Self::None => vec![],
            Self::Keyframes => (0..KEYFRAMES).map(|at| at * (all - 1) / (KEYFRAMES - 1)).collect(),
            Self::Clip => {
                let step = ((CLIP_STEP_S / dt_s).round() as usize).max(1);
                let start = (all / 2).saturating_sub(step * CLIP / 2);
                (0..CLIP).map(|at| start + at * step).filter(|frame| *frame < all).collect()
            }
        };
        chosen.dedup();
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_inside_the_flight_and_shown_once() {
        for all in [1, 2, 5, 240] {
            for frames in [TeacherFrames::None, TeacherFrames::Keyframes, TeacherFrames::Clip] {
                let chosen = frames.chosen(all, 0.5);
                assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]), "{chosen:?}");
                assert!(
                    chosen.iter().all(|frame| *frame < all) && chosen.is_empty() == (frames == TeacherFrames::None)
                );
            }
        }
        assert_eq!(TeacherFrames::Clip.chosen(240, 0.5), [112, 114, 116, 118, 120, 122, 124, 126]);
    }
}
