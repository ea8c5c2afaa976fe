//! A flight of any layout: the values of its files, absent where the files have none.

use cosfly_domain::{Camera, Colour};
use cosfly_frames::{DVec3, Pose};
use std::sync::Arc;

/// A flight. World frame: CARLA's (x east, y south, z up), metres, radians.
#[derive(Clone, Debug, Default)]
pub struct ExaminedEpisode {
    /// Name.
    pub id: String,
    /// Name of the flight, which several films may show; empty where episodes are flights.
    pub flight: String,
    /// Split, where the data have splits.
    pub split: Option<String>,
    /// Pedestrian or scenario: episodes of the same group belong to one split.
    pub group: String,
    /// Town; episodes with the same name share a place.
    pub place: String,
    /// Name of the town; empty where it is unknown.
    pub town: String,
    /// Whether the flight is perturbed on purpose: limits of motion do not apply.
    pub is_perturbed: bool,
    /// Longest displacement of the drone from its way in a single frame, metres: stated of twins of kind `jumps`, 0 of flights that a
    /// drone could fly; none where nothing is stated.
    pub displaced_m: Option<f64>,
    /// Camera of all frames; none where it is unknown or its lens is bent.
    pub camera: Option<Camera>,
    /// Whether depth is the distance along the ray of a pixel, as of pictures all around, and not along the optical axis.
    pub depth_is_along_rays: bool,
    /// Whether the place of the camera on the drone is unknown, so that cameras of moments are poses of the drone.
    pub is_mount_unknown: bool,
    /// Height of the target's body, metres.
    pub target_height_m: f64,
    /// Whether the target is of the kind `runner`.
    pub is_runner: bool,
    /// Clothes of the target, where they are known: colours of top and trousers, and whether there is a backpack.
    pub clothes: Option<(Colour, Colour, bool)>,
    /// Whether nobody else who is seen in the flight wears the same; none where it is unknown.
    pub is_unlike_all: Option<bool>,
    /// Time between frames, seconds: as stated, else as most frames have it.
    pub dt_s: f64,
    /// Stated limits of clearance (m), speed (m/s), acceleration (m/s^2), jerk (m/s^3), yaw and pitch rate (degrees/s).
    pub limits: [Option<f64>; 6],
    /// The frames.
    pub moments: Vec<ExaminedMoment>,
    /// Poses of the flight to whose next pose actions lead; none: the own poses.
    pub followed: Option<Vec<Pose>>,
    /// Pictures of some frames.
    pub looks: Vec<ExaminedLook>,
    /// The whole flight, of which the episode's frames are a part: the film that texts speak of.
    pub whole: Option<Arc<ExaminedEpisode>>,
    /// Whether the frames are a part of the flight's, and its other frames are unknown.
    pub is_part: bool,
    /// Language code and text of the instructions.
    pub captions: Vec<(String, String)>,
    /// Parked vehicles: middle (m), half lengths (m) and yaw (radians).
    pub vehicles: Vec<(DVec3, DVec3, f64)>,
}

/// The values of a frame.
#[derive(Clone, Debug)]
pub struct ExaminedMoment {
    /// Time, seconds.
    pub time_s: f64,
    /// Pose of the drone.
    pub drone: Pose,
    /// Pose of the camera.
    pub camera: Pose,
    /// Stated position of the drone in the next frame.
    pub next_in_world: Option<DVec3>,
    /// Stated turn to the next frame: pitch, yaw, roll, degrees.
    pub turn_deg: Option<[f64; 3]>,
    /// Middle of the target's body.
    pub target_in_world: Option<DVec3>,
    /// Walking direction (radians) and speed (m/s) of the target.
    pub heading_and_speed: Option<(f64, f64)>,
    /// Stated place of the target in the image, hidden or not: middle and height, pixels.
    pub in_image: Option<(f64, f64, f64)>,
    /// Box around the visible part of the target: left, top, right, bottom, pixels.
    pub visible_box: Option<[f64; 4]>,
    /// Visible share of the target, 0..=1.
    pub visible: Option<f64>,
    /// Distance to the nearest obstacle, metres.
    pub clearance_m: Option<f64>,
}

/// Measurements of the pictures of a frame.
#[derive(Clone, Debug, Default)]
pub struct ExaminedLook {
    /// The frame.
    pub frame: usize,
    /// Digest of the colour image's file.
    pub digest: String,
    /// Depth of the target: per frame offset in [`OFFSETS`], the nearest quarter of the depths in that frame's box.
    pub depth_m: Vec<Option<f64>>,
    /// Walls in the depth image, seen from the pose of the frame at each offset in [`OFFSETS`]: distance of the
    /// middle point from its wall, metres.
    pub walls_m: Vec<Option<f64>>,
    /// Distance of the camera, as the file of the pictures states it, from the nearest pose of the flight in the tables, metres,
    /// where they are apart; 0 where the camera is in its place and the file states other pixels of the target.
    pub elsewhere_m: Option<f64>,
    /// Height of the drawn ground around the target's feet over them, metres.
    pub rise_m: Option<f64>,
}

/// Number of consecutive frames whose pictures are read, in the middle of a flight.
const LOOKS: usize = 16;

/// The stretch of `frames` whose pictures are read.
pub fn stretch(frames: usize) -> std::ops::Range<usize> {
    let count = LOOKS.min(frames);
    let start = (frames - count) / 2;
    start..start + count
}

/// Offsets of the frames whose boxes and poses a depth image is compared with; the own frame first.
pub const OFFSETS: [i64; 5] = [0, -1, 1, -2, 2];

impl ExaminedEpisode {
    /// Depth of the target's middle in a frame, as its images have depth; its distance where the camera's axis is unknown.
    pub fn depth_of_target(&self, frame: usize) -> Option<f64> {
        let moment = self.moments.get(frame)?;
        let seen = moment.camera.body_from_world_point(moment.target_in_world?);
        if self.depth_is_along_rays || self.is_mount_unknown {
            Some(seen.length())
        } else {
            (seen.x > 0.0).then_some(seen.x)
        }
    }

    /// Lengths, in seconds, of the stretches with less than half of the target visible.
    pub fn losses_s(&self) -> Vec<f64> {
        let mut stretches: Vec<(usize, usize)> = vec![];
        for frame in (0..self.moments.len()).filter(|at| self.moments[*at].visible.is_some_and(|share| share < 0.5)) {
            match stretches.last_mut() {
                Some((start, count)) if *start + *count == frame => *count += 1,
                _ => stretches.push((frame, 1)),
            }
        }
        stretches.into_iter().map(|(_, count)| count as f64 * self.dt_s).collect()
    }
}

/// Lower quartile of the depths (rows of `width`) inside of a box, so that the ground behind the target does not count.
pub fn depth_in_box(depth_m: &[f32], width: usize, edges: [f64; 4]) -> Option<f64> {
    let height = depth_m.len().checked_div(width)?;
    let clamp = |value: f64, most: usize| value.clamp(0.0, most as f64) as usize;
    let (left, right) = (clamp(edges[0].floor(), width), clamp(edges[2].ceil(), width));
    let (top, bottom) = (clamp(edges[1].floor(), height), clamp(edges[3].ceil(), height));
    let rows = (top..bottom).flat_map(|row| &depth_m[row * width + left.min(right)..row * width + right]);
    let mut depths: Vec<f32> = rows.copied().filter(|depth| depth.is_finite()).collect();
    depths.sort_by(f32::total_cmp);
    depths.get(depths.len() / 4).map(|depth| f64::from(*depth))
}
