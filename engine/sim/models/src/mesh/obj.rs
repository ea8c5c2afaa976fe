//! Meshes of OBJ files with their materials and pictures, and colours of corners (`v x y z r g b`).

use super::builder::Builder;
use super::config::MeshPlace;
use super::materials::{self, NamedMaterial, Placing, libraries};
use super::textured::{MeshMaterial, MeshTriangle, TexturedMesh};
use cosfly_frames::DVec3;
use cosfly_scans::gltf::materials::TextureWrap;
use cosfly_scans::obj::in_triangles;
use cosfly_town::MapError;
use cosfly_town::text::decoded;
use std::collections::{BTreeMap, BTreeSet};

/// Most corners of a polygon.
const MOST_CORNERS: usize = 10_000;

pub(super) fn read(bytes: &[u8], beside: &[(String, Vec<u8>)], place: &MeshPlace) -> Result<TexturedMesh, MapError> {
    let no_mesh = |what: &str| {
        let error = MapError::new(format!("the file is neither glTF nor OBJ: it {what}"));
        error.hint("export the mesh as GLB, or as OBJ with its materials")
    };
    let text = decoded(bytes).map_err(|error| no_mesh(&format!("is no text ({})", error.message)))?;
    let builder = Builder::new("OBJ", place);
    let mut reader = Reader {
        builder,
        beside,
        points: vec![],
        colours: vec![],
        texture_places: vec![],
        known: BTreeMap::new(),
        libraries: BTreeSet::new(),
        pictures: BTreeMap::new(),
        meant: BTreeMap::new(),
        numbers: BTreeMap::new(),
        material: (0, Placing::default()),
        unknown: BTreeSet::new(),
        glass: 0,
        is_mesh: false,
    };
    reader.plain([1.0; 3], None);
    let mut whole = String::new();
    for (at, line) in text.lines().enumerate() {
        if let Some(begun) = line.strip_suffix('\\') {
            whole.push_str(begun);
            continue;
        }
        whole.push_str(line);
        let line = std::mem::take(&mut whole);
        reader.line(line.trim()).map_err(|error| {
            let shown: String = line.chars().take(60).collect();
            MapError { message: format!("line {} is `{shown}`; {}", at + 1, error.message), ..error }
        })?;
    }
    if !reader.is_mesh {
        return Err(no_mesh("has no line of corners"));
    }
    for (count, what) in [
        (reader.unknown.len(), "materials are in no file that the mesh names: they are drawn white"),
        (reader.glass, "materials let light through (`d`): they are drawn opaque"),
    ] {
        reader.builder.mesh.remarks.extend((count > 0).then(|| format!("{count} {what}")));
    }
    Ok(reader.builder.mesh)
}

struct Reader<'a> {
    builder: Builder<'a>,
    beside: &'a [(String, Vec<u8>)],
    points: Vec<DVec3>,
    /// Colours of the first corners; those without any are white.
    colours: Vec<[u8; 3]>,
    texture_places: Vec<[f32; 2]>,
    /// Materials of the files that were named so far.
    known: BTreeMap<String, NamedMaterial>,
    /// Those files.
    libraries: BTreeSet<String>,
    /// Numbers of textures by the names of their files and whether their edges go on.
    pictures: BTreeMap<(String, bool), u32>,
    /// Paths without a drive or root by the numbers of the files that they mean.
    meant: BTreeMap<usize, String>,
    /// Numbers of materials by name, and where places lie in their pictures.
    numbers: BTreeMap<String, (u32, Placing)>,
    /// The material of the faces that come now.
    material: (u32, Placing),
    /// Names of materials that no file has.
    unknown: BTreeSet<String>,
    /// Materials that light goes through.
    glass: usize,
    is_mesh: bool,
}

/// Fault of a line of a damaged file, in words.
fn damaged(rule: &str) -> MapError {
    MapError::new(rule).hint("the file seems to be damaged: export it again")
}

impl Reader<'_> {
    fn line(&mut self, line: &str) -> Result<(), MapError> {
        let (word, rest) = line.split_once([' ', '\t']).unwrap_or((line, ""));
        match word {
            "v" => self.vertex(rest)?,
            "vt" => {
                let mut numbers = rest.split_whitespace().map(|number| number.parse::<f32>().unwrap_or(0.0));
                let (u, v) = (numbers.next().unwrap_or(0.0), numbers.next().unwrap_or(0.0));
                self.texture_places.push([u, v]);
                self.builder.count(1)?;
            }
            "f" => self.face(rest)?,
            "mtllib" => libraries(rest).iter().try_for_each(|path| self.materials_of(path))?,
            "usemtl" => self.material = self.number_of(rest.trim())?,
            _ => {}
        }
        Ok(())
    }

    fn vertex(&mut self, rest: &str) -> Result<(), MapError> {
        let mut numbers = rest.split_whitespace().map_while(|number| number.parse::<f64>().ok());
        let [x, y, z] = [numbers.next(), numbers.next(), numbers.next()];
        let (Some(x), Some(y), Some(z)) = (x, y, z) else {
            return Err(damaged("a corner must have three numbers"));
        };
        self.is_mesh = true;
        self.builder.count(1)?;
        self.points.push(DVec3::new(x, y, z));
        let further: Vec<f64> = numbers.take(4).collect();
        if let [red, green, blue] = further[..] {
            self.colours.resize(self.points.len() - 1, [u8::MAX; 3]);
            self.colours.push([red, green, blue].map(|share| (255.0 * share.clamp(0.0, 1.0) + 0.5) as u8));
        }
        Ok(())
    }

    fn face(&mut self, rest: &str) -> Result<(), MapError> {
        let index = |word: Option<&str>, count: usize| {
            let number: i64 = word.filter(|word| !word.is_empty())?.parse().ok()?;
            let index = if number < 0 { (count as i64).checked_add(number)? } else { number.checked_sub(1)? };
            usize::try_from(index).ok().filter(|index| *index < count)
        };
        let (mut corners, mut places) = (Vec::new(), Vec::new());
        for word in rest.split_whitespace() {
            let mut parts = word.split('/');
            let corner = index(parts.next(), self.points.len());
            corners.push(corner.ok_or_else(|| damaged("a corner is no number of a corner before it"))?);
            places.push(index(parts.next(), self.texture_places.len()));
        }
        if !(3..=MOST_CORNERS).contains(&corners.len()) {
            return Err(damaged(&format!("a face must have at least three corners, and at most {MOST_CORNERS}")));
        }
        self.builder.count(corners.len())?;
        let points: Vec<DVec3> = corners.iter().map(|corner| self.points[*corner]).collect();
        let numbers: Vec<u32> = (0..points.len() as u32).collect();
        let (material, Placing { scale, shift, .. }) = self.material;
        // Places count from below here, from above in textures.
        let in_picture = |[u, v]: [f32; 2]| [u * scale[0] + shift[0], 1.0 - (v * scale[1] + shift[1])];
        for three in in_triangles(&numbers, &points) {
            let three = three.map(|corner| corner as usize);
            let look = MeshTriangle {
                corners_in_world: [[0.0; 3]; 3],
                texture_places: three
                    .map(|k| places[k].map_or([0.0; 2], |place| in_picture(self.texture_places[place]))),
                colours: three.map(|k| self.colours.get(corners[k]).copied().unwrap_or([u8::MAX; 3])),
                material,
            };
            self.builder.push(three.map(|k| points[k]), look)?;
        }
        Ok(())
    }

    fn file(&mut self, path: &str) -> Result<&[u8], MapError> {
        let names = self.beside.iter().map(|(name, _)| name.as_str());
        let found = materials::found(path, names).map_err(|several| {
            let shown: String = materials::name_of(path).chars().take(60).collect();
            if several.is_empty() {
                let error = MapError::new(format!("the mesh names the file `{shown}`, which is not among its `files`"));
                return error.hint(format!(
                    "name it beside the mesh: `files = [\"{shown}\"]`; no file is opened that the recipe does not name"
                ));
            }
            let several = several.join("`, `");
            let error = MapError::new(format!("the mesh names the file `{shown}`, which may be each of `{several}`"));
            error.hint("give these files different names, there and in the file that names them")
        })?;
        let known = self.meant.entry(found).or_insert_with(|| path.to_owned());
        let is_whole = |path: &str| path.starts_with('/') || path.contains(':');
        if !known.eq_ignore_ascii_case(path) && !is_whole(path) && !is_whole(known) {
            let name = &self.beside[found].0;
            let error = MapError::new(format!(
                "the mesh names the files `{known}` and `{path}`, but only one of this name is among its `files`: `{name}`"
            ));
            return Err(error.hint("name both beside the mesh: `files = [...]`"));
        }
        Ok(&self.beside[found].1)
    }

    fn materials_of(&mut self, path: &str) -> Result<(), MapError> {
        if !self.libraries.insert(path.to_owned()) {
            return Ok(());
        }
        let all = materials::read(self.file(path)?)?;
        self.known.extend(all.into_iter().map(|mut material| {
            material.picture = material.picture.map(|picture| materials::beside(path, &picture));
            (material.name.clone(), material)
        }));
        Ok(())
    }

    /// The number of a material by its name; of the plain one where no file has it.
    fn number_of(&mut self, name: &str) -> Result<(u32, Placing), MapError> {
        if let Some(number) = self.numbers.get(name) {
            return Ok(*number);
        }
        let Some(NamedMaterial { colour, picture, placing, is_glass, .. }) = self.known.get(name).cloned() else {
            self.unknown.insert(name.to_owned());
            return Ok((0, Placing::default()));
        };
        self.glass += usize::from(is_glass);
        let texture = picture.map(|picture| self.texture(&picture, placing.is_clamped)).transpose()?;
        let number = (self.plain(colour, texture), placing);
        self.numbers.insert(name.to_owned(), number);
        Ok(number)
    }

    fn texture(&mut self, name: &str, is_clamped: bool) -> Result<u32, MapError> {
        let key = (name.to_owned(), is_clamped);
        if let Some(known) = self.pictures.get(&key) {
            return Ok(*known);
        }
        let bytes = self.file(name)?.to_vec();
        let wrap = if is_clamped { TextureWrap::Clamp } else { TextureWrap::Repeat };
        let number = self.builder.texture(&bytes, &format!("`{name}`"), [wrap; 2])?;
        self.pictures.insert(key, number);
        Ok(number)
    }

    fn plain(&mut self, [red, green, blue]: [f32; 3], texture: Option<u32>) -> u32 {
        // Pictures with holes show them: OBJ has no word for it.
        let least_alpha = texture.filter(|it| self.builder.mesh.textures[*it as usize].has_holes()).map(|_| 0.5);
        self.builder.material(MeshMaterial { colour: [red, green, blue, 1.0], texture, least_alpha })
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::MeshConfig;
    use super::*;

    fn read(text: &str, beside: &[(String, Vec<u8>)]) -> Result<TexturedMesh, MapError> {
        let place = MeshConfig::new("scan.obj").place(DVec3::ZERO).expect("a place");
        TexturedMesh::read(text.as_bytes(), beside, &place)
    }

    #[test]
    fn polygons_materials_and_colours_of_corners_are_read() {
        let text = "mtllib ./a/scan.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 0 -1 0 0 1\nv 0 0 -1 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\n\
                    usemtl red\nf 1/1 2/2 3/3 4\nusemtl other\nf -4 -3 -2\n";
        let beside = [("scan.mtl".to_owned(), b"newmtl red\nKd 1 0 0\n".to_vec())];
        let mesh = read(text, &beside).expect("a mesh");
        assert_eq!((mesh.format, mesh.triangles.len(), mesh.materials.len()), ("OBJ", 3, 2));
        assert_eq!(mesh.triangles[0].texture_places[..2], [[0.0, 1.0], [1.0, 1.0]]);
        // The middle of a red, a green and a blue corner, through a red material.
        let look = mesh.look_at(&mesh.triangles[0], [1.0 / 3.0; 3], [[0.0; 2]; 2]);
        assert!((look[0] - 1.0 / 3.0).abs() < 1e-3 && look[1] == 0.0, "{look:?}");
        assert_eq!(mesh.triangles[2].material, 0);
    }

    #[test]
    fn pictures_of_one_name_in_several_folders_stay_apart() {
        let picture = |rgb: [u8; 3]| {
            let mut picture = vec![];
            let mut encoder = png::Encoder::new(&mut picture, 1, 1);
            encoder.set_color(png::ColorType::Rgb);
            encoder.write_header().and_then(|mut it| it.write_image_data(&rgb)).expect("a picture");
            picture
        };
        let text = "mtllib mats/scan.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 -1\nvt 0 0\n\
                    usemtl red\nf 1/1 2/1 3/1\nusemtl blue\nf 1/1 2/1 3/1\n";
        let materials = b"newmtl red\nmap_Kd red\\wall.png\nnewmtl blue\nmap_Kd \"../blue/wall.png\"\n".to_vec();
        let beside = [
            ("scan.mtl".to_owned(), materials),
            ("blue/wall.png".to_owned(), picture([0, 0, 255])),
            ("mats/red/wall.png".to_owned(), picture([255, 0, 0])),
        ];
        let mesh = read(text, &beside).expect("a mesh");
        let looks: Vec<[f32; 3]> = mesh
            .triangles
            .iter()
            .map(|it| mesh.look_at(it, [1.0 / 3.0; 3], [[0.0; 2]; 2]))
            .map(|it| [it[0], it[1], it[2]])
            .collect();
        assert_eq!(looks, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
        let text = text.replace("mats/scan", "scan");
        let beside = beside.map(|(name, bytes)| (name.replace("mats/red", "grey"), bytes));
        let error = read(&text, &beside).expect_err("refused");
        assert!(error.message.contains("may be each of `blue/wall.png`, `grey/wall.png`"), "{error}");
        let one = beside.map(|(name, bytes)| (name.replace("blue/", ""), bytes));
        let error = read(&text, &one[..2]).expect_err("refused");
        assert!(error.message.contains("names the files `red/wall.png` and `../blue/wall.png`"), "{error}");
    }

    #[test]
    fn files_that_the_recipe_does_not_name_are_never_opened() {
        for path in ["../../etc/passwd", "/etc/passwd", "C:\\x\\scan.mtl", "https://example.org/scan.mtl"] {
            let error = read(&format!("mtllib {path}\nv 0 0 0\n"), &[]).expect_err("refused");
            assert!(error.message.contains("not among its `files`"), "{error}");
        }
        let error = read("v 0 0 0\nv 1 0 0\nf 1 2 3\n", &[]).expect_err("refused");
        assert!(error.message.contains("line 3"), "{error}");
        assert!(read("hello", &[]).expect_err("refused").message.contains("neither glTF nor OBJ"));
        let place = MeshConfig::new("scan.obj").place(DVec3::ZERO).expect("a place");
        let picture = TexturedMesh::read(b"\x89PNG\r\n\x1a\n", &[], &place).expect_err("refused");
        assert!(picture.message.contains("neither glTF nor OBJ: it is no text"), "{picture}");
    }
}
