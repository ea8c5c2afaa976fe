//! Skins of models: textures as their files have them.

use crate::props::Skin;
use cosfly_materials::lanes::{Block, Shared, WIDE, groups};
use cosfly_materials::surface::Look;
use cosfly_materials::vector::Vec3;
use cosfly_models::Texture;

/// A triangle of a model.
#[derive(Clone, Copy, Debug)]
pub(super) struct Painted {
    skin: Skin,
    /// Colour in the simple look.
    pub(super) even: Vec3,
}

impl Painted {
    /// The look of a triangle.
    pub(super) fn new(skin: &Skin, textures: &[Texture]) -> Self {
        Self { skin: *skin, even: skin.mean(textures) }
    }
}

/// Looks up the texture of every pixel.
pub(super) fn painted(shared: &[Shared], blocks: &mut [Block], look: &Painted, textures: &[Texture]) {
    for (shared, four) in groups(shared, blocks) {
        for block in four {
            for k in 0..WIDE {
                let point = block.point(shared, k);
                let colour = look.skin.colour_at(textures, point.world, point.footprint_m);
                block.put(k, &Look::matt(colour, point.normal));
            }
        }
    }
}
