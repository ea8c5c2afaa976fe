//! Bodies as pictures show them: jointed people, vehicles with their riders, builds, clothes and paint.
//!
//! [`add_figure`] gives triangles in the world, [`FigureParts`] the same people as frustums. Looks are drawn from a body's
//! own seed, so that nobody changes when followed.

mod body_figure;
mod body_shape;
mod bounds;
pub mod build;
mod clothes;
mod frustum;
mod joints;
mod key_points;
mod person;
mod region;
mod triangles;
mod umbrella;
mod vehicles;
mod wardrobe;

pub use body_figure::{BodyFigure, FigureInPicture, gait_phase_rad, pedal_phase_rad};
pub use body_shape::{BodyShape, Posture};
pub use build::Build;
pub use clothes::{Clothes, Pattern, clothes_seed_of_target, grey_haired, outfit_of};
pub use frustum::{FigurePart, FigureTriangle, Ring, SIDES};
pub use key_points::key_points;
pub use person::{FigureParts, MOST_PARTS};
pub use region::Region;
pub use triangles::{add_figure, figure_triangles};
pub use vehicles::{Fittings, Livery};
pub use wardrobe::Wardrobe;
