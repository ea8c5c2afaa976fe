//! [`TexturedMesh`]: triangles of a file where they lie in the world, and their looks.

use super::texture::{MeshTexture, PixelSides, light};
use super::used_texels::UsedTexels;
use cosfly_frames::DVec3;

/// Triangles of a file where they lie in the world, and their looks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TexturedMesh {
    /// Triangles.
    pub triangles: Vec<MeshTriangle>,
    /// Looks that triangles name.
    pub materials: Vec<MeshMaterial>,
    /// Pictures that materials name.
    pub textures: Vec<MeshTexture>,
    /// Triangles that were left out: without extent, not finite, or farther than 20 km from the world's origin.
    pub left_out: usize,
    /// Differences from what the file means, in words.
    pub remarks: Vec<String>,
    /// The format's name.
    pub format: &'static str,
}

/// A triangle; both sides are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshTriangle {
    /// Corners, metres.
    pub corners_in_world: [[f32; 3]; 3],
    /// Places of the corners in the texture, from the left and from the top.
    pub texture_places: [[f32; 2]; 3],
    /// Colours of the corners, sRGB.
    pub colours: [[u8; 3]; 3],
    /// Number of the material.
    pub material: u32,
}

/// Look of triangles: the product of all colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshMaterial {
    /// Linear red, green, blue, and opacity.
    pub colour: [f32; 4],
    /// Number of the texture.
    pub texture: Option<u32>,
    /// Least opacity that is drawn; none where everything is.
    pub least_alpha: Option<f32>,
}

impl TexturedMesh {
    /// Lowest and highest corner, world, metres.
    pub fn bounds(&self) -> [DVec3; 2] {
        let corners = || self.triangles.iter().flat_map(MeshTriangle::corners);
        [corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max)]
    }

    /// Adds smaller copies to all pictures, of what triangles show of them.
    pub(super) fn add_copies(&mut self) {
        let mut used: Vec<UsedTexels> = self.textures.iter().map(MeshTexture::unused).collect();
        let mut is_cut = vec![true; self.textures.len()];
        for material in &self.materials {
            if let Some(texture) = material.texture {
                is_cut[texture as usize] &= material.least_alpha.is_some_and(|least| least > 0.0);
            }
        }
        for triangle in &self.triangles {
            if let Some(texture) = self.materials[triangle.material as usize].texture {
                used[texture as usize].add(triangle.texture_places);
            }
        }
        let parts = used.into_iter().zip(is_cut);
        self.textures.iter_mut().zip(parts).for_each(|(texture, (used, is_cut))| texture.add_copies(used, is_cut));
    }

    /// Linear colour and opacity of a triangle where its corners have these weights, for a pixel with these sides in its texture.
    pub fn look_at(&self, triangle: &MeshTriangle, weights: [f32; 3], pixel: PixelSides) -> [f32; 4] {
        let material = &self.materials[triangle.material as usize];
        let mut look = material.colour;
        if triangle.colours != [[u8::MAX; 3]; 3] {
            let light = light();
            let between = |channel: usize| {
                (0..3).map(|k| weights[k] * light[usize::from(triangle.colours[k][channel])]).sum::<f32>()
            };
            (0..3).for_each(|channel| look[channel] *= between(channel).clamp(0.0, 1.0));
        }
        if let Some(texture) = material.texture {
            let own = self.textures[texture as usize].sample(triangle.texture_place(weights), pixel);
            (0..4).for_each(|channel| look[channel] *= own[channel]);
        }
        look
    }
}

impl MeshTriangle {
    /// Corners in the world, metres.
    pub fn corners(&self) -> [DVec3; 3] {
        self.corners_in_world.map(|[x, y, z]| DVec3::new(x.into(), y.into(), z.into()))
    }

    /// The place in the texture where the corners have these weights.
    pub fn texture_place(&self, weights: [f32; 3]) -> [f32; 2] {
        [0, 1].map(|k| (0..3).map(|corner| weights[corner] * self.texture_places[corner][k]).sum())
    }
}
