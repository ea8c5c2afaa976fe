//! Pictures that a recipe asks for, against depth, labels and ids of the same frame and of the frames beside it.

use super::disparity::KnownDepths;
use super::film::Film;
use super::flow::{Carrier, ComparedPoints};
use super::flow_masks::FlowMasks;
use super::rows::{PlacedFlight, PlacedFrame};
use super::surfaces::Surfaces;
use cosfly_domain::channels::{ChannelSource, normals};
use cosfly_domain::{Channel, SemanticLabel};

/// Knowledge of a frame before its other pictures come.
pub struct KnownFrame<'a> {
    /// Number of the frame.
    pub frame: usize,
    /// Bytes of the depth picture.
    pub depths: &'a [u8],
    /// Bytes of the label picture; none where they could not be read.
    pub labels: Option<&'a [u8]>,
    /// Instance ids.
    pub ids: &'a [u32],
    /// Pixels of the target, in their order.
    pub of_target: Vec<usize>,
    /// Whether the log has a flow to compare with.
    pub has_flow: bool,
    /// Whether an id is of something that stands.
    pub stands: &'a dyn Fn(u32) -> bool,
    /// How the parts of a body with an id move; none of an id that nobody has.
    pub carries: &'a dyn Fn(u32) -> Option<Carrier>,
}

/// References for the pictures of the last frame.
#[derive(Default)]
pub struct OnRequest {
    frame: Option<usize>,
    of_target: Vec<usize>,
    points: ComparedPoints,
    masks: FlowMasks,
    disparities: KnownDepths,
    surfaces: Surfaces,
}

impl OnRequest {
    /// Goes on to a frame; what is wrong with a mask that waited for its depths.
    pub fn begin(&mut self, flight: &PlacedFlight, row: &PlacedFrame, known: KnownFrame<'_>) -> Option<String> {
        let KnownFrame { frame, depths, labels, ids, of_target, has_flow, stands, carries } = known;
        self.frame = Some(frame);
        self.of_target = of_target;
        self.disparities = KnownDepths::of(flight, depths);
        self.surfaces = Surfaces::of(flight, row, (depths, labels, ids), stands);
        if !has_flow {
            return None;
        }
        self.points = ComparedPoints::of(frame, depths, |pixel| {
            let id = *ids.get(pixel)?;
            if stands(id) {
                return Some((0, Carrier::Ground));
            }
            let is_rider = labels.is_some_and(|it| it.get(pixel) == Some(&SemanticLabel::Rider.id()));
            Some((id, carries(id).map(|kind| if is_rider { Carrier::Limbs } else { kind })?))
        });
        self.masks.begin(flight, depths)
    }

    /// Fault of a picture of a frame: rule and words.
    pub fn finding(
        &mut self,
        film: Film<'_>,
        (frame, channel): (usize, &Channel),
        stored: &[u8],
        width: usize,
    ) -> Option<(&'static str, String)> {
        let (flight, row) = (film.flight, film.frames.get(frame).filter(|_| self.frame == Some(frame))?);
        let in_rule = |rule: &'static str| move |message: String| (rule, message);
        match channel.source {
            ChannelSource::Target => self.mask_problem(stored).map(in_rule("verify-pixels")),
            ChannelSource::TargetAlone => self.amodal_problem(stored, width, row).map(in_rule("verify-pixels")),
            ChannelSource::Flow(_) => {
                let found = self.points.finding(film, (frame, channel), stored);
                found.map(in_rule("verify-flow"))
            }
            ChannelSource::FlowValid(to) => {
                let found = self.points.finding(film, (frame, channel), stored);
                let found = found.or_else(|| self.masks.finding(&self.points, film, (frame, to), stored));
                found.map(in_rule("verify-flow"))
            }
            ChannelSource::Bytes(_) if *channel == normals::CHANNEL => {
                self.surfaces.finding(stored).map(in_rule("verify-normals"))
            }
            _ => self.disparities.finding(flight, channel, stored).map(in_rule("verify-disparity")),
        }
    }

    /// Fault of the mask of the target's seen pixels, in words.
    fn mask_problem(&self, stored: &[u8]) -> Option<String> {
        let found: Vec<usize> = (0..stored.len()).filter(|at| stored[*at] != 0).collect();
        let is_same = found == self.of_target;
        let (found, expected) = (found.len(), self.of_target.len());
        (!is_same).then(|| format!("its {found} pixels are not the {expected} with the target's id"))
    }

    /// Fault of the mask of the target without obstacles, in words.
    fn amodal_problem(&self, stored: &[u8], width: usize, row: &PlacedFrame) -> Option<String> {
        let pixels: Vec<usize> = (0..stored.len()).filter(|at| stored[*at] != 0).collect();
        let found = edges(&pixels, width);
        if found != row.full_box() {
            return Some(format!(
                "its pixels lie in {found:?}; `full_box_px` of table `frames` is {:?}",
                row.full_box()
            ));
        }
        let outside = self.of_target.iter().find(|at| stored.get(**at).is_none_or(|byte| *byte == 0))?;
        Some(format!("pixel {outside} shows the target and is not part of it"))
    }
}

/// Edges around pixels of an image that is `width` wide.
pub fn edges(pixels: &[usize], width: usize) -> Option<[f64; 4]> {
    let columns = || pixels.iter().map(|at| at % width);
    let rows = || pixels.iter().map(|at| at / width);
    let (left, top) = (columns().min()?, rows().min()?);
    let (right, bottom) = (columns().max()? + 1, rows().max()? + 1);
    Some([left as f64, top as f64, right as f64, bottom as f64])
}
