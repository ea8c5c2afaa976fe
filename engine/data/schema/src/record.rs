//! The record model: one rendered trajectory with everything that tables, logs and cards contain about it.

use crate::log::FrameTimes;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::{
    Around, BodyInSpace, BodyKind, BodyPlan, BodyView, Camera, Followed, Lens, MapOrigin, MotionBlur, Mount, Noise,
    Optics, Outfit, RollingShutter, Season, StereoEye, Synthetic, TARGET_INSTANCE, TargetView, Town, Trajectory,
    Weather,
};
use cosfly_frames::{Pose, TargetState};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

/// Role of a flight behind a pedestrian.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Role {
    /// Optimised flight.
    Expert,
    /// Disturbed twin of an expert, for learning to recover.
    Perturbed,
}

impl Role {
    /// All roles, in the order of their class labels.
    pub const ALL: [Self; 2] = [Self::Expert, Self::Perturbed];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Expert => "expert",
            Self::Perturbed => "perturbed",
        }
    }
}

/// Facts about the town for a trajectory's metadata.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TownInfo {
    /// Short name.
    pub name: String,
    /// BLAKE3 of the town's encoded geometry, 64 hex digits.
    pub geometry_digest: String,
    /// Position of the world frame in the map file's frame.
    pub origin: MapOrigin,
    /// Synthetic parts of the town.
    pub synthetic: Synthetic,
}

impl TownInfo {
    /// Facts about `town`, whose encoded bytes have the digest `geometry_digest`.
    pub fn of(town: &Town, geometry_digest: impl ToString) -> Self {
        Self {
            name: town.name.clone(),
            geometry_digest: geometry_digest.to_string(),
            origin: town.origin.clone(),
            synthetic: town.synthetic.clone(),
        }
    }
}

/// Relation of a perturbed flight to its expert.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PairInfo {
    /// Published trajectory id of the expert.
    pub expert_id: String,
}

/// A body beside the target that pictures may show: a person, a vehicle or another drone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OtherBody {
    /// Id in instance images: after those of all objects, the same in all flights of a stage.
    pub instance: u32,
    /// Stage and item of a walk, such as `crowd-p00003`; traffic and number of a body of it, such as `street-b00003`.
    pub body_id: String,
    /// Kind, size and group.
    pub plan: BodyPlan,
    /// Clothes of a person or rider, paint of another vehicle.
    pub outfit: Outfit,
}

/// A frame in which a body beside the target covers at least one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sighting {
    /// Number of the frame.
    pub frame: u32,
    /// Index of the body in [`RenderedTrajectory::others`].
    pub other: u32,
    /// Position and motion of the body.
    pub state: TargetState,
    /// Visible pixels of the body.
    pub view: BodyView,
}

/// One trajectory with everything computed about it, except for the pixels (see [`cosfly_write::frame_pack`]). The
/// `index` blob of the render stage. World frame: CARLA's, metres, radians.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderedTrajectory {
    /// Id, unique in the dataset: letters, digits, `.`, `_` and `-`, such as `expert-p00000`.
    pub trajectory_id: String,
    /// Id of the flight in the pictures: the trajectory id without the weather or the camera that is appended
    /// where several films are made of it.
    pub flight_id: String,
    /// Expert or perturbed.
    pub role: Role,
    /// Item id of the target. Twins share it, and all flights behind one pedestrian go to the same split.
    pub pedestrian_id: String,
    /// The town.
    pub town: TownInfo,
    /// Poses, target track, costs, certificate, perturbation.
    pub trajectory: Trajectory,
    /// Name of the camera, where several film each flight.
    pub camera_name: Option<String>,
    /// Ideal camera of all frames, without its lens.
    pub camera: Camera,
    /// Distortion of the lens.
    pub lens: Lens,
    /// Place and rotation of the camera relative to the drone, whose poses the trajectory holds.
    pub mount: Mount,
    /// The camera in its stereo pair; `None` for a single one.
    pub stereo: Option<StereoEye>,
    /// Motion blur of the camera.
    pub motion_blur: MotionBlur,
    /// Rolling shutter of the camera.
    pub rolling_shutter: RollingShutter,
    /// Noise of the sensor.
    pub noise: Noise,
    /// Lens, sensor and image processor.
    pub optics: Optics,
    /// Weather of all frames.
    pub weather: Weather,
    /// Season of trees and lawns in the pictures.
    pub season: Season,
    /// First eight bytes of the item's seed as a number.
    pub seed: u64,
    /// View of the target in the image, per frame.
    pub views: Vec<TargetView>,
    /// Share of the target that hundreds of rays reach, 0..1, per frame, computed without the renderer; `None` out of
    /// view.
    pub visible_by_dense_rays: Vec<Option<f64>>,
    /// Clothes of the target; `None` for a target without a body.
    pub outfit: Option<Outfit>,
    /// The target, a body of traffic or of a walk of its own; `None` for a grown person on such a walk.
    pub followed: Option<Followed>,
    /// Bodies of traffic around the target, seen or not; none outside of traffic.
    pub around: Around,
    /// Bodies beside the target that pictures may show, by instance id.
    pub others: Vec<OtherBody>,
    /// Frames in which they are visible, by frame and instance id.
    pub sightings: Vec<Sighting>,
    /// Boxes and key points of the visible bodies, the target's among them, by frame and instance id; none where nobody asked.
    pub bodies_3d: Vec<BodyInSpace>,
    /// Relation to the expert; set for perturbed flights.
    pub pair: Option<PairInfo>,
    /// Time of the first picture after the beginning of the flight, nanoseconds: the offset of the camera.
    pub begins_ns: u64,
    /// Frames of the flight from one picture to the next.
    pub every: u32,
}

impl RenderedTrajectory {
    /// Number of frames.
    pub fn len(&self) -> usize {
        self.trajectory.poses_in_world.len()
    }

    /// Whether the record has no frame.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Time between frames, seconds.
    pub fn dt_s(&self) -> f64 {
        self.trajectory.track.dt_s
    }

    /// Times of the frames.
    pub fn times(&self) -> FrameTimes {
        FrameTimes { begins_ns: self.begins_ns, dt_s: self.dt_s() }
    }

    /// Id of the expert's flight; of an expert its own.
    pub fn flight_of_expert(&self) -> &str {
        let Some(pair) = &self.pair else { return &self.flight_id };
        let film = self.trajectory_id.strip_prefix(&self.flight_id).unwrap_or_default();
        pair.expert_id.strip_suffix(film).unwrap_or(&pair.expert_id)
    }

    /// Pose of the camera in a frame.
    pub fn camera_pose(&self, frame: usize) -> Pose {
        self.mount.camera_pose(&self.trajectory.poses_in_world[frame])
    }

    /// Bodies beside the target that are visible in a frame.
    pub fn seen_in(&self, frame: usize) -> impl Iterator<Item = (&OtherBody, &Sighting)> {
        let start = self.sightings.partition_point(|sighting| (sighting.frame as usize) < frame);
        let seen = self.sightings[start..].iter().take_while(move |sighting| sighting.frame as usize == frame);
        seen.map(|sighting| (&self.others[sighting.other as usize], sighting))
    }

    /// Kind of the target; `None` for a target without a body.
    pub fn target_kind(&self) -> Option<BodyKind> {
        let followed = self.followed.as_ref().map(|followed| followed.plan.kind);
        (self.trajectory.track.radius_m > 0.0).then(|| followed.unwrap_or(BodyKind::Pedestrian))
    }

    /// Number of visible bystanders in a frame who wear what the target wears: the same colours in words, a backpack or none.
    pub fn look_alikes(&self, frame: usize) -> usize {
        let Some(own) = &self.outfit else { return 0 };
        let is_alike = |other: &OtherBody| Some(other.plan.kind) == self.target_kind() && other.outfit.is_like(own);
        self.seen_in(frame).filter(|(other, _)| is_alike(other)).count()
    }

    /// Distance from the camera to the target's feet, metres.
    pub fn distance_m(&self, frame: usize) -> f64 {
        let feet = self.trajectory.track.states[frame].feet_in_world;
        (feet - self.camera_pose(frame).position_in_world).length()
    }

    /// Encodes an `index` blob.
    pub fn to_bytes(&self) -> Vec<u8> {
        encode(TRAJECTORY_MAGIC, self)
    }

    /// Decodes an `index` blob; lengths, names and numbers are checked, so that writers may rely on them.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let record: Self = decode("rendered trajectory", TRAJECTORY_MAGIC, bytes)?;
        record.check()?;
        Ok(record)
    }

    /// Checks that per-frame vectors have equal lengths, that names can be file names, and that all numbers are finite.
    pub fn check(&self) -> Result<()> {
        let frames = self.len();
        let trajectory = &self.trajectory;
        let lengths = [
            ("track.states", trajectory.track.len()),
            ("visibility", trajectory.visibility.len()),
            ("clearance_m", trajectory.clearance_m.len()),
            ("views", self.views.len()),
            ("visible_by_dense_rays", self.visible_by_dense_rays.len()),
            ("perturbation.frames", trajectory.perturbation.as_ref().map_or(frames, |p| p.frames.len())),
        ];
        let terms = trajectory.terms.iter().map(|term| (term.name.as_str(), term.per_frame.len()));
        let labels = trajectory.labels.iter().map(|label| (label.name.as_str(), label.per_frame.len()));
        let coverage = Some(trajectory.coverage.len()).filter(|length| *length > 0).map(|length| ("coverage", length));
        let all = lengths.into_iter().chain(terms).chain(labels).chain(coverage);
        if let Some((name, length)) = all.into_iter().find(|(_, length)| *length != frames) {
            return Err(self.refusal(format!("`{name}` has {length} frames; there are {frames} poses")));
        }
        for (what, name) in
            [("trajectory id", &self.trajectory_id), ("flight id", &self.flight_id), ("town name", &self.town.name)]
        {
            if !is_plain_name(name) {
                return Err(self.refusal(format!(
                    "{what} `{name}` must have 1 to 120 letters, digits, `.`, `_` or `-` and not begin with `.`"
                )));
            }
        }
        let dt_s = self.dt_s();
        if !(dt_s.is_finite() && dt_s > 0.0) {
            return Err(self.refusal(format!("`dt_s` is `{dt_s}`; it must be more than 0 s")));
        }
        let Mount { position_in_body_m, right_m, roll_rad, pitch_rad, yaw_rad, .. } = self.mount;
        let place = position_in_body_m.to_array();
        let mut optics =
            self.lens.coefficients().into_iter().chain(place).chain([right_m, roll_rad, pitch_rad, yaw_rad]);
        if !optics.all(f64::is_finite) {
            return Err(self.refusal("its lens or mount holds a number that is not finite".into()));
        }
        for (frame, (pose, state)) in trajectory.poses_in_world.iter().zip(&trajectory.track.states).enumerate() {
            let finite = pose.position_in_world.is_finite()
                && [pose.pitch_rad, pose.yaw_rad, pose.roll_rad].iter().all(|angle| angle.is_finite())
                && state.feet_in_world.is_finite()
                && state.heading_rad.is_finite()
                && state.speed_mps.is_finite();
            if !finite {
                return Err(self.refusal(format!("frame {frame} holds a number that is not finite")));
            }
        }
        self.check_others()
    }

    fn check_others(&self) -> Result<()> {
        let ids = |pair: &[OtherBody]| pair[0].instance < pair[1].instance;
        if !(self.others.windows(2).all(ids) && self.others.first().is_none_or(|it| it.instance > TARGET_INSTANCE)) {
            return Err(self.refusal("its bodies are not in the order of their ids".into()));
        }
        let key = |it: &Sighting| (it.frame, it.other);
        let is_sound = |it: &Sighting| {
            let other = self.others.get(it.other as usize);
            (it.frame as usize) < self.len()
                && other.is_some_and(|other| other.instance == it.view.instance)
                && it.state.feet_in_world.is_finite()
                && it.state.heading_rad.is_finite()
                && it.state.speed_mps.is_finite()
        };
        let is_ordered = self.sightings.windows(2).all(|pair| key(&pair[0]) < key(&pair[1]));
        match self.sightings.iter().find(|it| !is_sound(it)) {
            Some(it) => Err(self.refusal(format!("frame {} refers to a body that is not in the record", it.frame))),
            None if !is_ordered => Err(self.refusal("sightings are not in the order of frames".into())),
            None => Ok(()),
        }
    }

    fn refusal(&self, message: String) -> Box<Diagnostic> {
        Diagnostic::new("dataset-record", Fault::Bug, format!("trajectory `{}`: {message}", self.trajectory_id))
    }
}

/// Whether `name` can be part of a path of the published dataset on every system.
fn is_plain_name(name: &str) -> bool {
    (1..=120).contains(&name.len())
        && !name.starts_with('.')
        && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'_' | b'-'))
}

/// Facts about a finished log, known without opening it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogRecord {
    /// Id of the log's trajectory.
    pub trajectory_id: String,
    /// Expert or perturbed.
    pub role: Role,
    /// Item id of the target; decides the split.
    pub pedestrian_id: String,
    /// Town name; decides the folder.
    pub town: String,
    /// Number of frames.
    pub frames: u64,
    /// Number of messages on all channels.
    pub messages: u64,
    /// Size of the file, bytes.
    pub bytes: u64,
    /// SHA-256 of the file, 64 hex digits.
    pub sha256: String,
}

/// One caption of one trajectory.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaptionRecord {
    /// Two-letter code: `zh` or `en`.
    pub language: String,
    /// Kind of text, such as `instruction`.
    pub style: String,
    /// The text.
    pub text: String,
    /// Who wrote it: `template` or `teacher`.
    pub writer: String,
    /// Model that was asked; `None` where none was.
    pub model: Option<String>,
    /// Version of the prompt; `None` where no model was asked.
    pub prompt_version: Option<u32>,
    /// Number of answers that were judged.
    pub attempts: u32,
    /// Why the template wrote it although a model was asked.
    pub fallback: Option<String>,
    /// Subjects that the text speaks of; each was compared with the facts and is true.
    pub verdicts: Vec<String>,
    /// Answers that were refused before.
    pub refused: Vec<String>,
    /// Why they were refused.
    pub refused_because: Vec<String>,
    /// Subjects for which each of them was refused, such as `distance`, sorted; `form` where it was no text. Tables do not have
    /// them.
    pub refused_for: Vec<Vec<String>>,
}

/// An item without a trajectory, published with its reason.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rejection {
    /// Id that the trajectory would have had.
    pub trajectory_id: String,
    /// Stage that rejected it.
    pub stage: String,
    /// Item id of the pedestrian.
    pub pedestrian_id: String,
    /// Town name.
    pub town: String,
    /// Reason, in words.
    pub reason: String,
}

/// Small RGB previews of a trajectory's frames for the `frames` table; empty when previews are off.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PreviewStrip {
    /// One JPEG file per frame.
    pub jpegs: Vec<Vec<u8>>,
}

/// Encodes a captions blob.
pub fn captions_to_bytes(captions: &[CaptionRecord]) -> Vec<u8> {
    encode(CAPTIONS_MAGIC, &captions)
}

/// Decodes a captions blob.
pub fn captions_from_bytes(bytes: &[u8]) -> Result<Vec<CaptionRecord>> {
    decode("captions", CAPTIONS_MAGIC, bytes)
}

const TRAJECTORY_MAGIC: &[u8; 8] = b"CFTRAJ\x00\x0a";
const CAPTIONS_MAGIC: &[u8; 8] = b"CFCAPT\x00\x03";

/// Encodes eight bytes of kind and version, then postcard.
fn encode<T: Serialize>(magic: &[u8; 8], value: &T) -> Vec<u8> {
    postcard::to_extend(value, magic.to_vec()).expect("records are plain data that postcard writes to memory")
}

fn decode<T: DeserializeOwned>(what: &str, magic: &[u8; 8], bytes: &[u8]) -> Result<T> {
    let refuse = |message: String| Diagnostic::new("dataset-blob", Fault::Input, message);
    let Some((head, body)) = bytes.split_first_chunk::<8>() else {
        return Err(refuse(format!("the {what} ends after {} bytes", bytes.len())));
    };
    if head[..6] != magic[..6] {
        return Err(refuse(format!("these bytes are not a {what}")));
    }
    if head != magic {
        return Err(refuse(format!("the {what} has version {}; this cosfly reads version {}", head[7], magic[7])));
    }
    match postcard::take_from_bytes(body) {
        Ok((value, [])) => Ok(value),
        Ok((_, rest)) => {
            Err(refuse(format!("the {what} is followed by {} bytes that do not belong to it", rest.len())))
        }
        Err(error) => Err(refuse(format!("the {what} is damaged")).because(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn captions_survive_a_round_trip_and_damage_is_refused() {
        let captions = vec![CaptionRecord {
            language: "zh".into(),
            style: "instruction".into(),
            text: "跟随行人".into(),
            ..CaptionRecord::default()
        }];
        let bytes = captions_to_bytes(&captions);
        assert_eq!(captions_from_bytes(&bytes).unwrap(), captions);
        assert!(captions_from_bytes(&bytes[..bytes.len() - 1]).is_err());
        assert!(captions_from_bytes(b"CFCAPT\x00\x04").unwrap_err().message.contains("version 4"));
        assert!(captions_from_bytes(b"CFPREV\x00\x01").unwrap_err().message.contains("not a captions"));
    }

    #[test]
    fn names_that_would_leave_their_folder_are_refused() {
        for (name, plain) in [("expert-p00000", true), ("muco.p1", true), ("../x", false), ("", false), ("a/b", false)]
        {
            assert_eq!(is_plain_name(name), plain, "{name}");
        }
    }
}
