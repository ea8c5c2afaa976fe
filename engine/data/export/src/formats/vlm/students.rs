//! Sets for students of a teacher: nested shares, windows without some inputs, texts to learn, pairs of texts.

use super::conversation::{Shown, as_words, language_name, pose_text, task};
use super::options::Options;
use crate::source::ExportedFlight;
use cosfly_fingerprint::Digest;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Shares of the flights, percent; each holds the smaller ones. The whole is the split's own file.
pub const SHARES: [u64; 2] = [25, 50];
/// Windows without some inputs: the paper's ablation of modalities.
pub const ABLATIONS: [(&str, Shown); 4] = [
    ("no_pictures", Shown { pictures: false, poses: true, boxes: true }),
    ("no_boxes", Shown { pictures: true, poses: true, boxes: false }),
    ("no_poses", Shown { pictures: true, poses: false, boxes: true }),
    ("pictures_only", Shown { pictures: true, poses: false, boxes: false }),
];
/// Pictures of a flight beside a text.
const PICTURES: usize = 4;

/// Guide to the files of the sets, beside them.
pub const GUIDE: &str = "\
# Sets for students

For every split (`train` here), made from the same flights and pictures:

| file | content |
| --- | --- |
| `train.jsonl` | pictures, poses, boxes, instruction -> waypoints; 100 % of the flights |
| `train_25.jsonl`, `train_50.jsonl` | about 25 % and 50 % of the pedestrians; each file holds the smaller one |
| `train_no_pictures.jsonl`, `train_no_boxes.jsonl`, `train_no_poses.jsonl`, `train_pictures_only.jsonl` | the paper's ablation of inputs |
| `train_texts.jsonl` | pictures, poses -> text |
| `train_goals.jsonl` | pictures -> the goal of a flight or a step |
| `train_goal_checks.jsonl` | pictures, a goal -> whether it fits, and the subject of what is not so |
| `train_dialogues.jsonl` | pictures, a dialogue with a correction -> what the user says in the end |
| `train_preferences.jsonl` | pairs for DPO (LLaMA-Factory): the published text and an answer of the teacher that was refused |
| `train_preferences_swift.jsonl` | the same pairs for ms-swift |

The paper's paradigms are exports of their own: `--input perturbed` (denoising), `--input expert`, `--input mixed`.

```sh
llamafactory-cli train --stage sft --dataset_dir . --dataset cosfly_train_25 --media_dir . ...
llamafactory-cli train --stage dpo --dataset_dir . --dataset cosfly_train_preferences --media_dir . --pref_beta 0.1 ...
swift sft --dataset train_50.jsonl ...
swift rlhf --rlhf_type dpo --dataset train_preferences_swift.jsonl ...
```

Files of pairs exist only where a teacher wrote captions (`writer = \"teacher\"`) and some of its answers were refused.
";

/// Whether a flight is in a share, by a number of its pedestrian alone: twins are together, and more flights move none.
pub fn is_in_share(episode: &ExportedFlight<'_>, percent: u64) -> bool {
    let digest = Digest::of(episode.flight.pedestrian_id.as_bytes());
    let number = u64::from_le_bytes(digest.0[..8].try_into().unwrap_or_default());
    number % 100 < percent
}

/// Lines in which a model learns to write the texts of a flight, and pairs of a true and a refused text; each with the name of its
/// file after the split. `pictures` has the paths of the flight's pictures by frame.
pub fn texts(
    episode: &ExportedFlight<'_>,
    options: &Options,
    pictures: &BTreeMap<usize, String>,
) -> Vec<(&'static str, Value)> {
    let frames: Vec<usize> = pictures.keys().copied().collect();
    let Some(last) = frames.len().checked_sub(1) else { return vec![] };
    let mut shown: Vec<usize> = (0..PICTURES).map(|at| frames[at * last / (PICTURES - 1)]).collect();
    shown.dedup();
    let images: Vec<&String> = shown.iter().map(|frame| &pictures[frame]).collect();
    let language = options.instructions.language.code();
    let task = task(episode);
    let system =
        format!("You describe flights of a drone that {task}. State only what the pictures and the poses show.");
    let mut lines = vec![];
    for (number, caption) in episode.captions.iter().enumerate().filter(|(_, it)| it.language == language) {
        let id = format!("{}_text_{number:02}", episode.flight.trajectory_id);
        let asked = [
            json!({"role": "system", "content": system}),
            json!({"role": "user", "content": question(episode, &shown, language, &caption.style)}),
        ];
        let answer = |text: &str| json!({"role": "assistant", "content": as_words(text)});
        let line = |id: &str, messages: Vec<Value>| json!({"id": id, "trajectory_id": episode.flight.trajectory_id, "messages": messages, "images": images});
        lines.push(("texts", line(&id, asked.iter().cloned().chain([answer(&caption.text)]).collect())));
        for (pair, refused) in caption.refused.iter().filter(|text| !text.trim().is_empty()).enumerate() {
            let id = format!("{id}_{pair}");
            let mut ranked = line(&id, asked.to_vec());
            ranked["chosen"] = answer(&caption.text);
            ranked["rejected"] = answer(refused);
            ranked["chosen_writer"] = json!(caption.writer);
            lines.push(("preferences", ranked));
            let mut swift = line(&id, asked.iter().cloned().chain([answer(&caption.text)]).collect());
            swift["rejected_response"] = json!(as_words(refused));
            lines.push(("preferences_swift", swift));
        }
    }
    lines
}

fn question(episode: &ExportedFlight<'_>, shown: &[usize], language: &str, style: &str) -> String {
    let mut text = format!("{}\n", "<image>".repeat(shown.len()));
    let _ = writeln!(
        text,
        "Poses of the drone in these pictures, [x, y, z, pitch, yaw, roll], metres along the world's axes from the first place, degrees:"
    );
    let origin = episode.frames[shown[0]].pose.position_in_world;
    for frame in shown {
        let _ = writeln!(text, "{}", pose_text(&episode.frames[*frame].pose, origin));
    }
    let language = language_name(language);
    let _ = write!(
        text,
        "{} frames, {} s apart. Write the {style} of this flight in {language}.",
        episode.frames.len(),
        episode.flight.dt_s
    );
    text
}
