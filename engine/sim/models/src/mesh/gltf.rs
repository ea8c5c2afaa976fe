//! Meshes of glTF files: base colours, their textures, colours of corners, cut-outs.

use super::builder::Builder;
use super::config::MeshPlace;
use super::texture::code;
use super::textured::{MeshMaterial, MeshTriangle, TexturedMesh};
use cosfly_frames::DVec3;
use cosfly_scans::gltf::document::{Document, Primitive};
use cosfly_scans::gltf::materials::{Material, TextureWrap};
use cosfly_scans::gltf::{for_each_shape, triangles};
use cosfly_town::MapError;
use std::collections::{BTreeMap, BTreeSet};

pub(super) fn read(bytes: &[u8], place: &MeshPlace) -> Result<TexturedMesh, MapError> {
    let document = Document::read(bytes)?;
    let builder = Builder::new("glTF", place);
    let mut reader = Reader {
        document: &document,
        builder,
        materials: BTreeMap::new(),
        pictures: BTreeMap::new(),
        glass: BTreeSet::new(),
        unplaced: 0,
    };
    for_each_shape(&document, &mut |_, matrix, shape| reader.add(shape, &|point| matrix.transform_point3(point)))?;
    let Reader { glass, unplaced, mut builder, .. } = reader;
    builder.mesh.remarks = document.remarks();
    for (count, what) in [
        (glass.len(), "materials let light through (`KHR_materials_transmission`): they are drawn opaque"),
        (unplaced, "surfaces have no places in their picture: they have one colour of it"),
    ] {
        builder.mesh.remarks.extend((count > 0).then(|| format!("{count} {what}")));
    }
    Ok(builder.mesh)
}

struct Reader<'a> {
    document: &'a Document,
    builder: Builder<'a>,
    /// Numbers of materials by those of the file; the one of shapes without any.
    materials: BTreeMap<Option<usize>, u32>,
    /// Numbers of textures by those of pictures and what is beyond their edges.
    pictures: BTreeMap<(usize, [TextureWrap; 2]), u32>,
    /// Numbers of materials in the file that light goes through.
    glass: BTreeSet<usize>,
    /// Surfaces with a picture and without places in it.
    unplaced: usize,
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
            return Err(error.hint("export it again, as one whole file"));
        };
        let material = self.material(shape)?;
        let of_file = shape.material.and_then(|number| document.material(number));
        let texture = of_file.and_then(|it| it.base().1);
        let places = texture.and_then(|texture| document.texture_places(shape, texture)).unwrap_or_default();
        self.unplaced += usize::from(texture.is_some() && places.is_empty());
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
        let (colour, texture) = of_file.map_or(([1.0; 4], None), Material::base);
        self.glass.extend(shape.material.filter(|_| of_file.is_some_and(Material::is_glass)));
        let texture = texture.map(|texture| self.texture(texture.index)).transpose()?;
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
        let (picture, wraps) = self.document.picture_of(index)?;
        if let Some(known) = self.pictures.get(&(picture, wraps)) {
            return Ok(*known);
        }
        let bytes = self.document.picture(picture)?;
        let number = self.builder.texture(&bytes, &format!("picture {picture}"), wraps)?;
        self.pictures.insert((picture, wraps), number);
        Ok(number)
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::MeshConfig;
    use super::*;

    /// A triangle with a picture of red and green above blue and white; its places in it are packed, those of its second set stand still.
    fn triangle(material: &str, more: &str) -> Result<TexturedMesh, MapError> {
        let mut picture = vec![];
        let mut encoder = png::Encoder::new(&mut picture, 2, 2);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&[255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255]).expect("pixels");
        writer.finish().expect("an end");
        let corners = [[0_u8; 4], [1, 0, 0, 0], [0, 1, 0, 0]].concat();
        let sets = [[0_u8, 0], [255, 0], [0, 255], [1, 1], [1, 1], [1, 1]].map(|[u, v]| [u, v, 0, 0]).concat();
        let data = [corners, sets, picture.clone()].concat();
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"images":[{{"bufferView":2}}],"materials":[{{{material}}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":2}},"material":0}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5121,"count":3,"type":"VEC3"}},
            {{"bufferView":1,"componentType":5121,"normalized":true,"count":3,"type":"VEC2"}},
            {{"bufferView":1,"byteOffset":12,"componentType":5121,"count":3,"type":"VEC2"}}],
            "bufferViews":[{{"buffer":0,"byteLength":12,"byteStride":4}},{{"buffer":0,"byteOffset":12,"byteLength":24,"byteStride":4}},
            {{"buffer":0,"byteOffset":36,"byteLength":{}}}],"buffers":[{{"byteLength":{}}}]{more}}}"#,
            picture.len(),
            data.len()
        );
        let chunk = |kind: &[u8; 4], own: &[u8]| [&(own.len() as u32).to_le_bytes()[..], kind, own].concat();
        let chunks = [chunk(b"JSON", text.as_bytes()), chunk(b"BIN\0", &data)].concat();
        let file = [&b"glTF\x02\0\0\0"[..], &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat();
        read(&file, &MeshConfig::new("scan.glb").place(DVec3::ZERO).expect("a place"))
    }

    #[test]
    fn places_in_a_picture_are_moved_turned_and_of_the_set_that_is_named() {
        let places = |transform: &str| {
            let texture = format!(r#""index":0,"extensions":{{"KHR_texture_transform":{{{transform}}}}}"#);
            let material = format!(r#""pbrMetallicRoughness":{{"baseColorTexture":{{{texture}}}}}"#);
            let more = r#","textures":[{"source":0}],"extensionsRequired":["KHR_texture_transform"]"#;
            let mesh = triangle(&material, more).expect("a mesh");
            mesh.triangles[0].texture_places.map(|place| place.map(|at| (100.0 * at).round() / 100.0))
        };
        assert_eq!(places(""), [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(places(r#""offset":[0,1],"scale":[1,-1]"#), [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]]);
        // The extension's own example: the lower left quarter, the picture turned clockwise.
        let turned = places(r#""offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5]"#);
        assert_eq!(turned, [[0.0, 1.0], [0.0, 0.5], [0.5, 1.0]]);
        assert_eq!(places(r#""texCoord":1,"scale":[0.25,0.75]"#), [[0.25, 0.75]; 3]);
    }

    #[test]
    fn colours_of_other_shadings_are_drawn_and_the_rest_is_said_or_refused() {
        let look = |material: &str, more: &str| {
            let mesh = triangle(
                material,
                &format!(r#","textures":[{{"source":0,"sampler":0}}],"samplers":[{{"wrapS":33071}}]{more}"#),
            )
            .expect("a mesh");
            let look = mesh
                .look_at(&mesh.triangles[0], [1.0, 0.0, 0.0], [[0.0; 2]; 2])
                .map(|share| (100.0 * share).round() as i32);
            (look, mesh.remarks)
        };
        let required = r#","extensionsRequired":["KHR_materials_pbrSpecularGlossiness"]"#;
        let glossy = r#""extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[1,0.5,0.5,1],"diffuseTexture":{"index":0}}}"#;
        // Red and blue: the picture repeats downwards, and its left edge goes on.
        assert_eq!(look(glossy, required), ([50, 0, 25, 100], vec![]));
        let glowing = r#""pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1]},"emissiveFactor":[1,1,1],"emissiveTexture":{"index":0}"#;
        assert_eq!(look(glowing, "").0, [50, 0, 50, 100]);
        let (_, remarks) = look(r#""extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}"#, "");
        assert!(remarks[0].contains("1 materials let light through"), "{remarks:?}");
        let (_, remarks) = look(r#""pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":7}}"#, "");
        assert!(remarks[0].contains("no places in their picture"), "{remarks:?}");
        let textured = r#""pbrMetallicRoughness":{"baseColorTexture":{"index":0}}"#;
        let packed =
            r#","textures":[{"extensions":{"ACME_texture":{"source":0}}}],"extensionsRequired":["ACME_texture_a"]"#;
        for (more, words) in [(packed, "`ACME_texture`"), (r#","extensionsRequired":["ACME_folds"]"#, "`ACME_folds`")] {
            let error = triangle(textured, more).expect_err("refused");
            assert!(error.message.contains(words) && !error.hints.is_empty(), "{error:?}");
        }
    }
}
