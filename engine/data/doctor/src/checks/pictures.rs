//! Pictures that repeat.

use cosfly_episodes::{ExaminedEpisode, Flag};

/// Finds equal files in neighbouring frames whose poses differ.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    let repeated: Vec<usize> = episode
        .looks
        .windows(2)
        .filter(|pair| {
            let [a, b] = [pair[0].frame, pair[1].frame];
            let moves = episode.moments[a].camera != episode.moments[b].camera;
            !pair[0].digest.is_empty() && pair[0].digest == pair[1].digest && moves
        })
        .map(|pair| pair[1].frame)
        .collect();
    match repeated.first() {
        Some(first) => {
            let message = format!(
                "{} of {} pictures are copies of the one before although the camera moves; the first is frame {first}",
                repeated.len(),
                episode.looks.len()
            );
            vec![Flag::damage("duplicate-frames", &episode.id, message)]
        }
        None => vec![],
    }
}
