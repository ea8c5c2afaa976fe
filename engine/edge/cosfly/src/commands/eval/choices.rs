//! Words of the command line of `cosfly eval`, and their meanings.

use clap::ValueEnum;
use cosfly_evaluate::InputRole;
use cosfly_evaluate::pictures::PictureKind;
use cosfly_metrics::baselines::Anchor;
use cosfly_metrics::{DeltaFrame, DeltaOrigin};

/// Kind of predictions.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum KindChoice {
    /// Waypoints of the drone
    Waypoints,
    /// Depth of every pixel: a folder of 16-bit PNG or .npy files
    Depth,
    /// Label of every pixel: a folder of 8-bit PNG or .npy files
    Semantic,
    /// Boxes: COCO results, or JSON lines of them
    Boxes,
    /// Masks: COCO results with `segmentation`
    Masks,
    /// Tracks of many bodies: a folder of MOTChallenge's files
    Tracks,
    /// Boxes of the target alone: a folder of OTB's, UAV123's or LaSOT's files
    Target,
}

/// Axes of increments.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum FrameChoice {
    /// The world's axes
    World,
    /// The body's axes
    Body,
}

/// Start of increments.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum OriginChoice {
    /// At the waypoint before
    Previous,
    /// At the current pose
    Current,
}

/// Start of the first increment.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum AnchorChoice {
    /// At the pose of the drone
    Input,
    /// At the pose of the expert
    Expert,
}

/// Flights that models see.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum RoleChoice {
    /// Perturbed flights
    Perturbed,
    /// Experts' flights
    Expert,
}

impl KindChoice {
    /// The kind of pictures; none for waypoints.
    pub fn of_pictures(self) -> Option<PictureKind> {
        match self {
            Self::Waypoints => None,
            Self::Depth => Some(PictureKind::Depth),
            Self::Semantic => Some(PictureKind::Semantic),
            Self::Boxes => Some(PictureKind::Boxes),
            Self::Masks => Some(PictureKind::Masks),
            Self::Tracks => Some(PictureKind::Tracks),
            Self::Target => Some(PictureKind::Target),
        }
    }
}

impl From<FrameChoice> for DeltaFrame {
    fn from(choice: FrameChoice) -> Self {
        match choice {
            FrameChoice::World => Self::World,
            FrameChoice::Body => Self::Body,
        }
    }
}

impl From<OriginChoice> for DeltaOrigin {
    fn from(choice: OriginChoice) -> Self {
        match choice {
            OriginChoice::Previous => Self::Previous,
            OriginChoice::Current => Self::Current,
        }
    }
}

impl From<AnchorChoice> for Anchor {
    fn from(choice: AnchorChoice) -> Self {
        match choice {
            AnchorChoice::Input => Self::Input,
            AnchorChoice::Expert => Self::Expert,
        }
    }
}

impl From<RoleChoice> for InputRole {
    fn from(choice: RoleChoice) -> Self {
        match choice {
            RoleChoice::Perturbed => Self::Perturbed,
            RoleChoice::Expert => Self::Expert,
        }
    }
}
