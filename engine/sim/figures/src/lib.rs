//! Bodies as pictures show them: jointed people, vehicles with their riders, builds, clothes and paint.
//!
//! [`figure`] gives triangles in the world, [`figure::FigureParts`] the same people as frustums. Looks are drawn from a body's
//! own seed, so that nobody changes when followed.

mod body_shape;
mod bounds;
pub mod build;
pub mod clothes;
pub mod figure;
mod umbrella;
mod vehicles;
mod wardrobe;

pub use body_shape::BodyShape;
pub use build::Build;
pub use clothes::{Clothes, Pattern, clothes_seed_of_target, outfit_of};
pub use figure::{Bystander, TargetSetup, Walker, gait_phase_rad, pedal_phase_rad, target_triangles, walker_triangles};
pub use vehicles::Livery;
pub use wardrobe::Wardrobe;
