//! Figures of a textured mesh for `cosfly map inspect`: triangles, pictures, open edges, and how its key in a recipe is written.

use cosfly_diagnose::counted;
use cosfly_experts::map_files::ReadMap;
use cosfly_models::mesh::{self, MeshConfig, MeshSurvey, NamedFile, TexturedMesh, name_of, named_files};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Component, Path};

/// Most bytes of all files beside a mesh that are read.
const MOST_BYTES_BESIDE: u64 = 1 << 30;

/// Figures for programs; none for other formats. `parameters` are those of the stage `map`, which tell the unit.
pub fn figures(file: &Path, map: &ReadMap, parameters: &[String]) -> Option<Value> {
    if !matches!(map.format, "glTF" | "OBJ") {
        return None;
    }
    let bytes = std::fs::read(file).ok()?;
    let option = |name: &str| {
        let given = parameters
            .iter()
            .find_map(|change| change.strip_prefix("options.")?.strip_prefix(name)?.strip_prefix('='))?;
        Some(given.trim().trim_matches('"'))
    };
    let mut config = MeshConfig { unit_m: option("unit_m").and_then(|it| it.parse().ok()), ..MeshConfig::new("") };
    if let Some(axis) = option("up_axis") {
        config.up_axis = serde_json::from_value(axis.into()).ok()?;
    }
    let files = if map.format == "OBJ" { beside(file, &bytes) } else { vec![] };
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    let place = config.place(map.town.origin.offset_m).ok()?;
    Some(match TexturedMesh::read(&bytes, &files, &place) {
        Ok(mesh) => {
            let MeshSurvey { triangles, left_out, textures, has_colours, textured_share, open_edges_m, remarks } =
                MeshSurvey::of(&mesh);
            json!({
                "triangles": triangles, "left_out": left_out, "textures": textures, "has_colours": has_colours,
                "textured_share": textured_share, "open_edges_m": open_edges_m, "files": names,
                "remarks": remarks,
            })
        }
        Err(error) => {
            json!({ "files": names, "refused": error.message, "hints": error.hints, "missing": missing(&bytes, &files) })
        }
    })
}

/// Files in the mesh's own folder, and in folders inside it, that it names, and those that its materials name; where a path
/// leads out of the folder or to nothing, the file of its name in the folder. Names are paths from there.
pub fn beside(file: &Path, bytes: &[u8]) -> Vec<NamedFile> {
    let mut files: Vec<NamedFile> = vec![];
    let mut names = named_files(bytes);
    let (mut seen, mut left) = (BTreeSet::new(), MOST_BYTES_BESIDE);
    let length_of = |name: &str| {
        let is_inside = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        let found = std::fs::metadata(file.with_file_name(name)).ok().filter(|it| is_inside && it.is_file())?;
        Some((name.to_owned(), found.len()))
    };
    while let Some(name) = names.pop() {
        let Some((name, length)) = length_of(&name).or_else(|| length_of(name_of(&name))) else { continue };
        if !seen.insert(name.clone()) {
            continue;
        }
        let Some(rest) = left.checked_sub(length) else { continue };
        let Ok(bytes) = std::fs::read(file.with_file_name(&name)) else { continue };
        left = rest;
        if Path::new(&name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mtl")) {
            names.extend(named_files(&bytes).iter().map(|picture| mesh::beside(&name, picture)));
        }
        files.push((name, bytes));
    }
    files.sort();
    files
}

/// Names of the files that an OBJ file and its materials name and that are not among `files`.
fn missing(bytes: &[u8], files: &[NamedFile]) -> BTreeSet<String> {
    let mut all = named_files(bytes);
    let is_library = |name: &str| Path::new(name).extension().is_some_and(|it| it.eq_ignore_ascii_case("mtl"));
    all.extend(files.iter().filter(|(name, _)| is_library(name)).flat_map(|(_, bytes)| named_files(bytes)));
    let is_there = |name: &str| files.iter().any(|(file, _)| name_of(file).eq_ignore_ascii_case(name_of(name)));
    all.into_iter().filter(|name| !is_there(name)).collect()
}

/// Figures for people.
pub fn text(figures: &Value) -> String {
    let mut text = String::new();
    if let Some(why) = figures["refused"].as_str() {
        let _ = write!(text, "mesh: cannot be drawn with its textures: {why}");
        let missing = figures["missing"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let missing: Vec<String> = missing.map(|name| format!("`{name}`")).collect();
        if !missing.is_empty() {
            let _ = write!(
                text,
                "\nmesh: not found in its folder: {}; put them there, or name them in `files` of a recipe",
                missing.join(", ")
            );
        }
        return text;
    }
    let pictures = figures["textures"].as_array().map_or(&[][..], Vec::as_slice);
    let _ = write!(text, "mesh: {} triangles, {}", figures["triangles"], counted(pictures.len(), "picture"));
    if let Some(largest) = pictures.iter().max_by_key(|size| size[0].as_u64().max(size[1].as_u64())) {
        let share = 100.0 * figures["textured_share"].as_f64().unwrap_or_default();
        let _ = write!(text, " of up to {} x {} pixels on {share:.0} % of them", largest[0], largest[1]);
    }
    if figures["has_colours"] == true {
        text.push_str(", colours of corners");
    }
    if let Some(open_m) = figures["open_edges_m"].as_f64() {
        let _ = write!(text, "; {open_m:.0} m of open edges: rims of holes and of the scan");
    }
    if let Some(left_out @ 1..) = figures["left_out"].as_u64() {
        let _ = write!(
            text,
            "; {left_out} without extent or far away are not drawn",
            left_out = counted(left_out, "triangle")
        );
    }
    for remark in figures["remarks"].as_array().into_iter().flatten().filter_map(Value::as_str) {
        let _ = write!(text, "; {remark}");
    }
    if let Some(files) = figures["files"].as_array().filter(|files| !files.is_empty()) {
        let _ = write!(text, "\nmesh: in a recipe, `files = {}`", Value::from(files.clone()));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_in_folders_inside_the_mesh_s_own_are_found() {
        let folder = tempfile::tempdir().expect("a folder");
        let inside = |name: &str| folder.path().join("scan").join(name);
        std::fs::create_dir_all(inside("my maps/a")).expect("folders");
        for name in ["my maps/scan.mtl", "my maps/a/wall.png", "b.png", "c.png", "../out.png"] {
            std::fs::write(inside(name), "").expect("a file");
        }
        let materials = "map_Kd a\\wall.png\nmap_Kd ..\\b.png\nmap_Kd D:\\x\\c.png\nmap_Kd ../../out.png\n";
        std::fs::write(inside("my maps/scan.mtl"), materials).expect("a file");
        let found = beside(&inside("scan.obj"), b"mtllib ./my maps/scan.mtl\n");
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["b.png", "c.png", "my maps/a/wall.png", "my maps/scan.mtl"]);
        assert_eq!(Vec::from_iter(missing(b"mtllib my maps/scan.mtl\n", &found)), ["../../out.png"]);
    }
}
