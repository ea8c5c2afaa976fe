//! Meanings of the features of a LeRobot dataset, from the names of their parts, which differ between datasets.

use cosfly_diagnose::plausible;
use cosfly_frames::{DVec3, Pose, real};
use serde_json::Value;

/// Meaning of a number of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// Along an axis: x, y, z.
    Along(usize),
    /// About an axis: pitch, yaw, roll.
    About(usize),
    /// A part of a quaternion: w, x, y, z.
    Quaternion(usize),
    /// An edge of a box: left, top, right, bottom.
    Edge(usize),
}

/// A choice of the numbers of a feature.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts<const N: usize> {
    /// Name of the feature.
    pub feature: String,
    /// Indices of the numbers in the feature.
    pub at: [usize; N],
}

impl<const N: usize> Parts<N> {
    /// The numbers in a row of the feature; `None` where the row is shorter or a number is not plausible.
    pub fn of(&self, row: &[f64]) -> Option<[f64; N]> {
        let numbers = self.at.map(|at| row.get(at).copied().unwrap_or(f64::NAN));
        numbers.iter().all(|number| plausible(*number).is_ok()).then_some(numbers)
    }
}

/// Form of the angles.
#[derive(Clone, Debug, PartialEq)]
pub enum Angles {
    /// Pitch, yaw, roll.
    Euler(Parts<3>),
    /// Yaw alone.
    Yaw(Parts<1>),
    /// w, x, y, z.
    Quaternion(Parts<4>),
}

/// The features with a known meaning.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Features {
    /// Position of the drone.
    pub position: Option<Parts<3>>,
    /// Angles of the drone.
    pub angles: Option<Angles>,
    /// Position of the target.
    pub target: Option<Parts<3>>,
    /// The target's box in the image.
    pub edges: Option<Parts<4>>,
    /// The three numbers of actions along axes.
    pub action: Option<Parts<3>>,
    /// The three angles of actions.
    pub turn: Option<Parts<3>>,
    /// Pictures inside of tables, of colours.
    pub pictures: Vec<String>,
    /// Pictures of depth in metres, inside of tables.
    pub depth: Option<String>,
    /// Pictures of depth in other units, or in videos.
    pub other_depth: Vec<String>,
    /// Pictures in video files.
    pub videos: Vec<String>,
}

/// Words in the names of features that are not the drone's state.
const OTHERS: [&str; 10] =
    ["action", "target", "goal", "image", "box", "bbox", "velocity", "vel", "acceleration", "person"];

impl Features {
    /// Meanings of `features` in `meta/info.json`.
    pub fn of(features: &Value) -> Self {
        let mut found = Self::default();
        for (name, feature) in features.as_object().into_iter().flatten() {
            match feature["dtype"].as_str() {
                Some("image") if found.depth.is_none() && is_depth(feature) && feature["info"]["depth_unit"] == "m" => {
                    found.depth = Some(name.clone());
                }
                Some("image") if is_depth(feature) => found.other_depth.push(name.clone()),
                Some("image") => found.pictures.push(name.clone()),
                Some("video") => found.videos.push(name.clone()),
                _ => found.vector(name, feature),
            }
        }
        found
    }

    fn vector(&mut self, name: &str, feature: &Value) {
        let words = words(name);
        let is = |word: &str| words.iter().any(|it| it == word);
        let roles = roles(feature, &words, is("action"));
        let set = |slot: &mut Option<Parts<3>>, of: fn(usize) -> Role| {
            if slot.is_none() {
                *slot = parts(name, &roles, of);
            }
        };
        if is("action") {
            set(&mut self.action, Role::Along);
            set(&mut self.turn, Role::About);
            if self.action.is_none() && roles.len() >= 3 && roles.iter().all(Option::is_none) {
                self.action = Some(Parts { feature: name.to_owned(), at: [0, 1, 2] });
            }
        } else if self.edges.is_none() && (is("box") || is("bbox")) {
            self.edges = parts(name, &roles, Role::Edge);
        } else if is("target") || is("goal") || is("person") {
            set(&mut self.target, Role::Along);
        } else if !OTHERS.iter().any(|word| is(word)) {
            set(&mut self.position, Role::Along);
            if self.angles.is_none() {
                let yaw = || parts(name, &roles, |_| Role::About(1)).map(Angles::Yaw);
                let euler = parts(name, &roles, Role::About).map(Angles::Euler);
                self.angles = euler.or_else(|| parts(name, &roles, Role::Quaternion).map(Angles::Quaternion));
                self.angles = self.angles.take().or_else(yaw);
            }
        }
    }
}

/// Whether a feature is marked as depth.
fn is_depth(feature: &Value) -> bool {
    feature["info"]["is_depth_map"] == true
}

fn parts<const N: usize>(feature: &str, roles: &[Option<Role>], of: fn(usize) -> Role) -> Option<Parts<N>> {
    let mut at = [0; N];
    for (part, place) in at.iter_mut().enumerate() {
        *place = roles.iter().position(|role| *role == Some(of(part)))?;
    }
    Some(Parts { feature: feature.to_owned(), at })
}

/// Lower-case words of a name.
fn words(name: &str) -> Vec<String> {
    let parts = name.split(|letter: char| !letter.is_ascii_alphanumeric());
    parts.filter(|word| !word.is_empty()).map(str::to_ascii_lowercase).collect()
}

/// Meaning of each number of a feature, from its name, or from the feature's where numbers have no names.
fn roles(feature: &Value, words: &[String], of_action: bool) -> Vec<Option<Role>> {
    let count = feature["shape"][0].as_u64().unwrap_or(0).min(1024) as usize;
    let names = &feature["names"];
    // Some datasets put the list below a word such as `motors` or `axes`.
    let names = names.as_array().or_else(|| names.as_object()?.values().find_map(Value::as_array));
    if let Some(names) = names.filter(|names| names.len() == count) {
        return names.iter().map(|name| role(name.as_str().unwrap_or_default(), of_action)).collect();
    }
    let is = |known: &[&str]| words.iter().any(|word| known.contains(&word.as_str()));
    match count {
        3 if is(&["position", "pos", "xyz", "location", "translation"]) => {
            (0..3).map(|axis| Some(Role::Along(axis))).collect()
        }
        3 if is(&["rpy", "euler"]) => [2, 0, 1].map(|angle| Some(Role::About(angle))).to_vec(),
        1 => vec![role(&words.join("_"), of_action)],
        _ => vec![None; count],
    }
}

/// Meaning of a number with this name; increments and velocities have one in actions only.
fn role(name: &str, of_action: bool) -> Option<Role> {
    let words = words(name);
    let units = ["m", "mps", "deg", "rad", "metres", "meters", "degrees", "radians", "pixels"];
    // Steps of chunks of actions have numbers: the first of a name counts.
    let is_number = |word: &str| word.bytes().all(|byte| byte.is_ascii_digit());
    let word = words.iter().rev().find(|word| !units.contains(&word.as_str()) && !is_number(word))?;
    Some(match word.as_str() {
        "dx" | "vx" if of_action => Role::Along(0),
        "dy" | "vy" if of_action => Role::Along(1),
        "dz" | "vz" if of_action => Role::Along(2),
        "dpitch" if of_action => Role::About(0),
        "dyaw" if of_action => Role::About(1),
        "droll" if of_action => Role::About(2),
        "x" | "px" | "posx" => Role::Along(0),
        "y" | "py" | "posy" => Role::Along(1),
        "z" | "pz" | "posz" => Role::Along(2),
        "pitch" => Role::About(0),
        "yaw" | "heading" | "psi" => Role::About(1),
        "roll" => Role::About(2),
        "qw" => Role::Quaternion(0),
        "qx" => Role::Quaternion(1),
        "qy" => Role::Quaternion(2),
        "qz" => Role::Quaternion(3),
        "left" | "xmin" | "x1" => Role::Edge(0),
        "top" | "ymin" | "y1" => Role::Edge(1),
        "right" | "xmax" | "x2" => Role::Edge(2),
        "bottom" | "ymax" | "y2" => Role::Edge(3),
        _ => return None,
    })
}

/// The pose of a position and angles. `in_degrees` concerns Euler angles and yaws.
pub fn pose(position_in_world: DVec3, angles: Option<&Angles>, row: &[f64], in_degrees: bool) -> Option<Pose> {
    let radians = |angle: f64| if in_degrees { angle.to_radians() } else { angle };
    let [pitch_rad, yaw_rad, roll_rad] = match angles {
        None => [0.0; 3],
        Some(Angles::Euler(parts)) => parts.of(row)?.map(radians),
        Some(Angles::Yaw(parts)) => [0.0, radians(parts.of(row)?[0]), 0.0],
        Some(Angles::Quaternion(parts)) => {
            let [w, x, y, z] = parts.of(row)?;
            let yaw = real::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
            [0.0, yaw, 0.0]
        }
    };
    Some(Pose { position_in_world, pitch_rad, yaw_rad, roll_rad })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn our_own_names_are_understood() {
        let vector = |names: &[&str]| json!({"dtype": "float32", "shape": [names.len()], "names": names});
        let found = Features::of(&json!({
            "observation.images.rgb": {"dtype": "image", "shape": [4, 4, 3], "names": ["height", "width", "channels"]},
            "observation.images.depth": {"dtype": "image", "shape": [4, 4, 1], "info": {"is_depth_map": true, "depth_unit": "m"}},
            "observation.state": vector(&["dx", "dy", "dz", "dpitch", "dyaw", "droll", "pitch", "roll"]),
            "privileged.pose": vector(&["x", "y", "z", "pitch", "yaw", "roll"]),
            "privileged.target": vector(&["x", "y", "z"]),
            "privileged.box": vector(&["left", "top", "right", "bottom"]),
            "action": vector(&["dx_1", "dy_1", "dz_1", "dpitch_1", "dyaw_1", "droll_1", "dx_2", "dy_2", "dz_2"]),
            "timestamp": {"dtype": "float32", "shape": [1], "names": null},
        }));
        let state = |at| Parts { feature: "privileged.pose".into(), at };
        assert_eq!(found.position, Some(state([0, 1, 2])));
        assert_eq!(found.angles, Some(Angles::Euler(state([3, 4, 5]))));
        assert_eq!(found.target.map(|it| it.feature), Some("privileged.target".into()));
        assert_eq!(found.edges.map(|it| it.at), Some([0, 1, 2, 3]));
        assert_eq!((found.action.map(|it| it.at), found.turn.map(|it| it.at)), (Some([0, 1, 2]), Some([3, 4, 5])));
        assert_eq!(found.pictures, ["observation.images.rgb"]);
        assert_eq!(found.depth.as_deref(), Some("observation.images.depth"));
    }

    #[test]
    fn names_of_others_are_understood() {
        let found = Features::of(&json!({
            "observation.images.front": {"dtype": "video", "shape": [4, 4, 3]},
            "observation.velocity": {"dtype": "float32", "shape": [3], "names": ["vx", "vy", "vz"]},
            "observation.pose": {"dtype": "float64", "shape": [7],
                "names": {"axes": ["uav_pos_x", "uav_pos_y", "uav_pos_z", "qx", "qy", "qz", "qw"]}},
            "action": {"dtype": "float32", "shape": [4], "names": null},
        }));
        assert_eq!(found.position.map(|it| it.feature), Some("observation.pose".into()));
        assert!(matches!(found.angles, Some(Angles::Quaternion(Parts { at: [6, 3, 4, 5], .. }))));
        assert_eq!(found.action.map(|it| it.at), Some([0, 1, 2]));
        assert_eq!((found.videos, found.target), (vec!["observation.images.front".to_owned()], None));
        let split = Features::of(&json!({
            "observation.position": {"dtype": "float32", "shape": [3], "names": null},
            "observation.yaw_rad": {"dtype": "float32", "shape": [1], "names": null},
        }));
        assert_eq!(split.position.map(|it| it.at), Some([0, 1, 2]));
        assert!(matches!(split.angles, Some(Angles::Yaw(Parts { at: [0], .. }))));
    }
}
