//! Meshes of glTF files: base colours, their textures, colours of corners, cut-outs.

use super::builder::Builder;
use super::config::MeshPlace;
use super::texture::code;
use super::textured::{MeshMaterial, MeshTriangle, TexturedMesh};
use cosfly_frames::DVec3;
use cosfly_scans::gltf::document::{Document, Primitive};
use cosfly_scans::gltf::{for_each_shape, triangles};
use cosfly_town::MapError;
use std::collections::BTreeMap;

pub(super) fn read(bytes: &[u8], place: &MeshPlace) -> Result<TexturedMesh, MapError> {
    let document = Document::read(bytes)?;
    let builder = Builder::new("glTF", place);
    let mut reader = Reader { document: &document, builder, materials: BTreeMap::new(), pictures: BTreeMap::new() };
    for_each_shape(&document, &mut |_, matrix, shape| reader.add(shape, &|point| matrix.transform_point3(point)))?;
    Ok(reader.builder.mesh)
}

struct Reader<'a> {
    document: &'a Document,
    builder: Builder<'a>,
    /// Numbers of materials by those of the file; the one of shapes without any.
    materials: BTreeMap<Option<usize>, u32>,
    /// Numbers of textures by those of pictures.
    pictures: BTreeMap<usize, u32>,
}

impl Reader<'_> {
    fn add(&mut self, shape: &Primitive, in_scene: &dyn Fn(DVec3) -> DVec3) -> Result<(), MapError> {
        let document = self.document;
        self.builder.count(document.elements_of_shape(shape))?;
        let Some((points, corners)) = triangles(document, shape) else {
            // Points and lines have nothing to draw; a surface that cannot be read must not be missing unnoticed.
            if !(4..=6).contains(&shape.mode.unwrap_or(4)) {
                return Ok(());
            }
            let error = MapError::new("a surface of the mesh cannot be read");
            return Err(error.hint("export it without compression (Draco, meshopt), as one whole file"));
        };
        let material = self.material(shape)?;
        let of_file = shape.material.and_then(|number| document.material(number));
        let set = of_file.and_then(|it| it.pbr_metallic_roughness.base_color_texture.as_ref());
        let places = set.and_then(|it| shape.attributes.get(&format!("TEXCOORD_{}", it.tex_coord)));
        let places = places.and_then(|accessor| document.texture_coordinates(*accessor)).unwrap_or_default();
        let colours = shape.attributes.get("COLOR_0").and_then(|accessor| document.colours(*accessor));
        let colours: Vec<[u8; 3]> = colours.unwrap_or_default().into_iter().map(|colour| colour.map(code)).collect();
        let points: Vec<DVec3> = points.into_iter().map(in_scene).collect();
        for three in corners {
            let corner = |k: usize| points.get(three[k] as usize).copied();
            let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) else {
                self.builder.mesh.left_out += 1;
                continue;
            };
            let look = MeshTriangle {
                corners_in_world: [[0.0; 3]; 3],
                texture_places: three.map(|at| places.get(at as usize).copied().unwrap_or_default()),
                colours: three.map(|at| colours.get(at as usize).copied().unwrap_or([u8::MAX; 3])),
                material,
            };
            self.builder.push([a, b, c], look)?;
        }
        Ok(())
    }

    /// The number of a shape's material.
    fn material(&mut self, shape: &Primitive) -> Result<u32, MapError> {
        if let Some(known) = self.materials.get(&shape.material) {
            return Ok(*known);
        }
        let of_file = shape.material.and_then(|number| self.document.material(number));
        let colours = of_file.map(|it| &it.pbr_metallic_roughness);
        let texture = match colours.and_then(|it| it.base_color_texture.as_ref()) {
            Some(texture) => Some(self.texture(texture.index)?),
            None => None,
        };
        let colour = colours.map_or([1.0; 4], |it| it.base_color_factor);
        let colour = colour.map(|share| if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 });
        // What lets light through is drawn where it is more opaque than not.
        let least_alpha = of_file.and_then(|it| match it.alpha_mode.as_deref() {
            Some("MASK") => Some(it.alpha_cutoff.filter(|least| least.is_finite()).unwrap_or(0.5)),
            Some("BLEND") => Some(0.5),
            _ => None,
        });
        let number = self.builder.material(MeshMaterial { colour, texture, least_alpha });
        self.materials.insert(shape.material, number);
        Ok(number)
    }

    fn texture(&mut self, index: usize) -> Result<u32, MapError> {
        let Some(picture) = self.document.picture_of(index) else {
            let error = MapError::new(format!("texture {index} names no picture that is read: it may be KTX2 or WebP"));
            let hint = "export the mesh with PNG or JPEG pictures: `gltf-transform ktxdecompress` makes PNG of KTX2, `gltf-transform png` of WebP";
            return Err(error.hint(hint));
        };
        if let Some(known) = self.pictures.get(&picture) {
            return Ok(*known);
        }
        let number = self.builder.texture(&self.document.picture(picture)?, &format!("picture {picture}"))?;
        self.pictures.insert(picture, number);
        Ok(number)
    }
}
