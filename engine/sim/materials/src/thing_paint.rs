//! Paints the faces of things: which look each kind and form has.

use super::lanes::{Block, Shared, WIDE, groups};
use super::pattern::NoiseTexture;
use super::thing_form::ThingForm;
use super::things::{BoxThing, metal};
use super::vector::Vec3;
use cosfly_domain::ObstacleKind;
use cosfly_frames::simd_kernel;

/// Asks the look of every pixel. Not a function: closures are not always inlined, and only what is inlined becomes
/// vector code.
macro_rules! paint_all {
    ($put:ident, $self:ident, $shared:ident, $blocks:ident, $point:ident, $at:ident => $look:expr) => {
        for (shared, four) in groups($shared, $blocks) {
            for block in four {
                for k in 0..WIDE {
                    let $point = block.point(shared, k);
                    let $at = $self.place::<AXIS>(&$point);
                    let look = $look;
                    block.$put(k, &look);
                }
            }
        }
    };
}

impl BoxThing {
    #[inline(always)]
    fn all<const AXIS: usize>(&self, shared: &[Shared], blocks: &mut [Block], noise: &NoiseTexture) {
        if self.form != ThingForm::Plain {
            return self.all_of_form::<AXIS>(shared, blocks, noise);
        }
        match self.kind {
            // Shaded together, see `leaves`.
            ObstacleKind::TreeCrown | ObstacleKind::Bush => {}
            ObstacleKind::TreeTrunk => {
                paint_all!(put, self, shared, blocks, point, at => self.bark(&point, &at, noise))
            }
            ObstacleKind::Car => paint_all!(put, self, shared, blocks, point, at => self.car::<AXIS>(&point, &at)),
            ObstacleKind::Lamp => paint_all!(put, self, shared, blocks, point, at => self.lamp(&point, &at)),
            ObstacleKind::TrafficLight => {
                paint_all!(put, self, shared, blocks, point, at => self.traffic_light::<AXIS>(&point, &at));
            }
            ObstacleKind::TrafficSign => {
                paint_all!(put, self, shared, blocks, point, at => self.sign::<AXIS>(&point, &at))
            }
            ObstacleKind::Fence | ObstacleKind::GuardRail => {
                paint_all!(put, self, shared, blocks, point, at => self.fence(&point, &at));
            }
            ObstacleKind::Wall | ObstacleKind::Bridge | ObstacleKind::Building => {
                paint_all!(put, self, shared, blocks, point, at => self.stone(&point, &at, noise));
            }
            ObstacleKind::Pole => paint_all!(put, self, shared, blocks, point, _at => metal(&point, Vec3::splat(0.22))),
            ObstacleKind::Stall => paint_all!(put, self, shared, blocks, point, at => self.stall(&point, &at, noise)),
            ObstacleKind::Static | ObstacleKind::Bench => {
                paint_all!(put, self, shared, blocks, point, at => self.furniture(&point, &at, noise))
            }
        }
    }

    #[inline(always)]
    fn all_of_form<const AXIS: usize>(&self, shared: &[Shared], blocks: &mut [Block], noise: &NoiseTexture) {
        match self.form {
            ThingForm::Plain => {}
            ThingForm::Container => {
                paint_all!(put, self, shared, blocks, point, at => self.container::<AXIS>(&point, &at, noise));
            }
            ThingForm::Hull | ThingForm::Ship => {
                paint_all!(put, self, shared, blocks, point, at => self.hull::<AXIS>(&point, &at, noise))
            }
            ThingForm::Cabin => paint_all!(put, self, shared, blocks, point, at => self.cabin::<AXIS>(&point, &at)),
            ThingForm::Sheet => paint_all!(put, self, shared, blocks, point, at => self.sheet(&point, &at, noise)),
            ThingForm::Rim | ThingForm::Paint | ThingForm::White => {
                paint_all!(put, self, shared, blocks, point, _at => self.paint(&point));
            }
            ThingForm::Glass | ThingForm::Pool => {
                paint_all!(put, self, shared, blocks, point, _at => self.glass(&point));
            }
        }
    }
}

simd_kernel! {
    /// The look of a box that is not a building.
    pub fn things(shared: &[Shared], blocks: &mut [Block], thing: &BoxThing, noise: &NoiseTexture) {
        let thing = *thing;
        match thing.axis {
            0 => thing.all::<0>(shared, blocks, noise),
            1 => thing.all::<1>(shared, blocks, noise),
            _ => thing.all::<2>(shared, blocks, noise),
        }
    }
}
