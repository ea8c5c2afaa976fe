//! Materials and textures of a glTF file, as far as base colours ask for them.

use cosfly_frames::real;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Looks of a shape.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct Material {
    pbr_metallic_roughness: Option<Colours>,
    /// `OPAQUE`, `MASK` or `BLEND`; none is opaque.
    pub alpha_mode: Option<String>,
    /// Least opacity that is drawn with `MASK`; none is a half.
    pub alpha_cutoff: Option<f32>,
    emissive_factor: [f32; 3],
    emissive_texture: Option<TextureUse>,
    extensions: MaterialExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct MaterialExtensions {
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    glossiness: Option<Colours>,
    #[serde(rename = "KHR_materials_transmission")]
    transmission: Transmission,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Transmission {
    transmission_factor: f64,
}

/// Base colour of a material, in either of its two shadings.
#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Colours {
    #[serde(alias = "diffuseFactor")]
    base_color_factor: [f32; 4],
    #[serde(alias = "diffuseTexture")]
    base_color_texture: Option<TextureUse>,
}

impl Default for Colours {
    fn default() -> Self {
        Self { base_color_factor: [1.0; 4], base_color_texture: None }
    }
}

/// A texture as a material has it.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct TextureUse {
    /// Number of the texture.
    pub index: usize,
    tex_coord: usize,
    extensions: UseExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct UseExtensions {
    #[serde(rename = "KHR_texture_transform")]
    transform: Option<TextureTransform>,
}

/// Where the places of a shape lie in a picture of many.
#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct TextureTransform {
    offset: [f32; 2],
    rotation: f64,
    scale: [f32; 2],
    tex_coord: Option<usize>,
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], tex_coord: None }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Texture {
    pub(super) source: Option<usize>,
    pub(super) sampler: Option<usize>,
    pub(super) extensions: BTreeMap<String, Value>,
}

/// Extensions by which a texture names a picture that is neither PNG nor JPEG.
pub(crate) const PICTURES: [&str; 2] = ["EXT_texture_webp", "KHR_texture_basisu"];

impl Texture {
    /// Number of its picture: the plain one where it has two.
    pub(super) fn picture(&self) -> Option<usize> {
        let packed =
            || PICTURES.iter().find_map(|name| self.extensions.get(*name)?["source"].as_u64()?.try_into().ok());
        self.source.or_else(packed)
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Sampler {
    wrap_s: Option<u32>,
    wrap_t: Option<u32>,
}

/// Continuation of a texture beyond the edge of its picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum TextureWrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The picture again, every other time from its other side.
    Mirror,
    /// The pixels of the edge.
    Clamp,
}

impl Material {
    /// Factor of the base colour (linear red, green, blue, and alpha) and its texture. Where a black or no colour glows, it is the glow's: so are scans
    /// of programs that know no unlit materials.
    pub fn base(&self) -> ([f32; 4], Option<&TextureUse>) {
        let of = |colours: &Colours| {
            colours.base_color_factor.map(|share| if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 })
        };
        let Some(own) = self.pbr_metallic_roughness.as_ref().or(self.extensions.glossiness.as_ref()) else {
            return self.glow().unwrap_or(([1.0; 4], None));
        };
        let factor = of(own);
        let is_black = factor[..3] == [0.0; 3];
        let glow = self.glow().filter(|_| is_black);
        glow.map_or((factor, own.base_color_texture.as_ref()), |([red, green, blue, _], texture)| {
            ([red, green, blue, factor[3]], texture)
        })
    }

    fn glow(&self) -> Option<([f32; 4], Option<&TextureUse>)> {
        let [red, green, blue] =
            self.emissive_factor.map(|share| if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 });
        (red + green + blue > 0.0).then_some(([red, green, blue, 1.0], self.emissive_texture.as_ref()))
    }

    /// Whether light goes through it.
    pub fn is_glass(&self) -> bool {
        self.extensions.transmission.transmission_factor > 0.5
    }
}

impl TextureUse {
    /// Number of the set of places that it takes.
    pub(super) fn set(&self) -> usize {
        self.extensions.transform.as_ref().and_then(|it| it.tex_coord).unwrap_or(self.tex_coord)
    }

    /// A place of the set in the picture.
    pub(super) fn placed(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        let Some(TextureTransform { offset, rotation, scale, .. }) = &self.extensions.transform else { return [u, v] };
        // Counter-clockwise as pictures are seen: places count downwards.
        let (sin, cos) = real::sin_cos(*rotation);
        let (sin, cos, u, v) = (sin as f32, cos as f32, u * scale[0], v * scale[1]);
        [offset[0] + cos * u + sin * v, offset[1] - sin * u + cos * v]
    }
}

impl Sampler {
    /// Continuation beyond the edges of a picture, across and down.
    pub(super) fn wraps(&self) -> [TextureWrap; 2] {
        [self.wrap_s, self.wrap_t].map(|code| match code {
            Some(33071) => TextureWrap::Clamp,
            Some(33648) => TextureWrap::Mirror,
            _ => TextureWrap::Repeat,
        })
    }
}
