//! Hostile scans and meshes through the real binary: refused or read within bounded memory and time, and never with another file opened.

use crate::support::{cosfly, repository_root};
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, Instant};

/// Far beyond what any of these files takes: a guard against hanging, not a measurement.
const HANGS_AFTER: Duration = Duration::from_secs(60);

/// Runs `map inspect` and gives its exit code and what it says, on both streams.
fn inspected(folder: &Path, name: &str, bytes: &[u8]) -> (Option<i32>, String) {
    let file = folder.join(name);
    std::fs::write(&file, bytes).expect("writable");
    let begun = Instant::now();
    let printed = cosfly(&["map", "inspect", name, "--json"]).within(folder).run();
    assert!(begun.elapsed() < HANGS_AFTER, "{name}: {:?}", begun.elapsed());
    // Where lines are broken is no matter of these tests.
    let said = printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
    (printed.code, printed.stdout + &said)
}

#[track_caller]
fn check_refused(name: &str, bytes: &[u8], words: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, said) = inspected(folder.path(), name, bytes);
    assert!(code == Some(4) || code == Some(3), "{name}: {code:?}\n{said}");
    assert!(said.contains(words) && said.contains("help: "), "{name}: {said}");
}

/// A GLB file: text, then data.
fn glb(json: &str, data: &[u8]) -> Vec<u8> {
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8; 4], content: &[u8]| [&(content.len() as u32).to_le_bytes(), &kind[..], content].concat();
    let chunks = [chunk(b"JSON", &text), chunk(b"BIN\0", data)].concat();
    [&b"glTF"[..], &2_u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

#[test]
fn claims_of_any_size_are_refused_with_a_way_out() {
    let many = "{},".repeat(20_000) + "{}";
    let buffers = format!(r#"{{"asset":{{"version":"2.0"}},"nodes":[{{}}],"buffers":[{{"byteLength":1}},{many}]}}"#);
    check_refused("buffers.glb", &glb(&buffers, &[0; 100_000]), "buffer 1 has no data");
    let zeros = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":1}}]}],
        "accessors":[{"componentType":5126,"count":2000000,"type":"VEC3"},{"componentType":5126,"count":90000,"type":"VEC3"}],
        "buffers":[{"byteLength":2000000}]}"#;
    check_refused("places.glb", &glb(zeros, &[0; 2_000_000]), "places");
    let many_places = zeros.replace("\"count\":2000000", "\"count\":900000");
    check_refused("corners.glb", &glb(&many_places, &[0; 2_000_000]), "too many corners");
    let circle = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}]}"#;
    check_refused("circle.gltf", circle.as_bytes(), "nested deeper");
    let nodes = (0..30).map(|at| format!(r#"{{"children":[{0},{0}]}}"#, at + 1)).collect::<Vec<_>>().join(",");
    let twice = format!(r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{nodes},{{}}]}}"#);
    check_refused("twice.gltf", twice.as_bytes(), "more than");
    check_refused(
        "deep.gltf",
        format!("{{\"asset\":{{}},\"meshes\":{}", "[".repeat(100_000)).as_bytes(),
        "cannot be read",
    );
    let ply = "ply\nformat ascii 1.0\nelement vertex 18446744073709551615\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
    check_refused("count.ply", ply.as_bytes(), "the file ends before");
    check_refused("lists.ply", ply.replace("property float x", "property list uchar float x").as_bytes(), "list");
    let pcd = |size: &str, data: &str| {
        format!("VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n{size}\nDATA {data}\n").into_bytes()
    };
    check_refused("count.pcd", &pcd("POINTS 4000000000", "binary"), "the file ends before");
    let mut packed = pcd("POINTS 80000000", "binary_compressed");
    packed.extend([4_000_000_u32.to_le_bytes(), 960_000_000_u32.to_le_bytes()].concat());
    packed.resize(packed.len() + 4_000_000, 0xff);
    check_refused("bomb.pcd", &packed, "unpack to");
    let laz = std::fs::read(repository_root().join("tests/fuzz/corpus/las/example.laz")).expect("the corpus is there");
    let mut claims = laz;
    claims[107..111].copy_from_slice(&u32::MAX.to_le_bytes());
    claims[247..255].copy_from_slice(&u64::MAX.to_le_bytes());
    check_refused("claims.laz", &claims, "points");
}

#[test]
fn elements_that_come_twice_or_are_unknown_are_named_with_their_line() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
    for (from, to, words) in [
        ("end_header", "element vertex 3\nend_header", "line 7 of the head is `element vertex 3`; there is an element"),
        ("format ascii 1.0", "format ascii 1.0\nformat binary_little_endian 1.0", "line 3 of the head"),
        ("property float z", "property float z\nproperty float z", "several numbers called `z`"),
        (
            "property float z",
            "property float z\nproperty uchar class\nproperty uchar class",
            "several numbers called `class`",
        ),
        ("element", "elment", "line 3 of the head is `elment vertex 1`; known are"),
    ] {
        check_refused("changed.ply", ply.replacen(from, to, 1).as_bytes(), words);
    }
    let pcd = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n0 0 0\n";
    for (from, to, words) in [
        ("FIELDS x y z", "FIELDS x y z\nFIELDS x y z", "line 3 of the head is `FIELDS x y z`; there is such a line"),
        ("POINTS 1", "POINTS 2", "states 2 `POINTS`"),
        ("POINTS 1", "POINTS -1", "`POINTS` is `-1`"),
        ("SIZE 4 4 4", "SIZE 4 4 4 4", "`SIZE` has 4 values for 3 `FIELDS`"),
        ("HEIGHT 1", "HIGHT 1", "line 6 of the head is `HIGHT 1`; known are"),
    ] {
        check_refused("changed.pcd", pcd.replacen(from, to, 1).as_bytes(), words);
    }
}

#[test]
fn faces_before_vertices_and_comments_with_keywords_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let points: String =
        (0..900).map(|at| format!("{} {} 0\n", 0.5 * f64::from(at % 30), 0.5 * f64::from(at / 30))).collect();
    let head = "ply\nformat ascii 1.0\ncomment not yet the end_header\nelement face 1\nproperty list uchar int vertex_indices\n\
                element vertex 900\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    let (code, said) = inspected(folder.path(), "text.ply", format!("{head}3 0 1 30\n{points}").as_bytes());
    assert_eq!(code, Some(0), "{said}");
    let mut binary = head.replace("ascii", "binary_little_endian").into_bytes();
    binary.extend([3]);
    binary.extend([0_i32, 1, 30].iter().flat_map(|corner| corner.to_le_bytes()));
    for at in 0..900 {
        binary.extend(
            [0.5 * (at % 30) as f32, 0.5 * (at / 30) as f32, 0.0].iter().flat_map(|number| number.to_le_bytes()),
        );
    }
    let (code, other) = inspected(folder.path(), "binary.ply", &binary);
    assert_eq!(code, Some(0), "{other}");
    let area =
        |said: &str| said.split("\"area_m2\": ").nth(1).map(|rest| rest.lines().next().unwrap_or_default().to_owned());
    assert!(area(&said).is_some() && area(&said) == area(&other), "{said}\n{other}");
}

/// What `map inspect` says of a town, and the files that it read beside the mesh.
fn without_mesh(said: &str) -> (Value, Value) {
    let mut said: Value = serde_json::Deserializer::from_str(said).into_iter().next().expect("JSON").expect("JSON");
    let mesh = said.as_object_mut().and_then(|said| said.remove("mesh")).expect("figures of the mesh");
    (said, mesh["files"].clone())
}

#[test]
fn no_file_of_another_folder_that_a_mesh_names_is_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let town =
        std::fs::read_to_string(repository_root().join("tests/fuzz/corpus/obj/example.obj")).expect("the corpus");
    let (code, plain) = inspected(folder.path(), "town.obj", town.as_bytes());
    assert_eq!(code, Some(0), "{plain}");
    std::fs::write(folder.path().join("secret.mtl"), "newmtl stone\nmap_Kd ../../secret.png\n").expect("writable");
    for link in ["secret.mtl", "../secret.mtl", "/etc/passwd", "file:///etc/passwd", "http://localhost:9/a.mtl"] {
        let named = format!("mtllib {link}\nusemtl stone\n{town}");
        let (_, said) = inspected(folder.path(), "town.obj", named.as_bytes());
        let (town_of_it, files) = without_mesh(&said);
        assert_eq!(town_of_it, without_mesh(&plain).0, "{link}");
        assert_eq!(files, if link.ends_with("secret.mtl") { json!(["secret.mtl"]) } else { json!([]) }, "{link}");
        let gltf = format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[],"meshes":[],"buffers":[{{"byteLength":4,"uri":"{link}"}}]}}"#
        );
        check_refused(
            "town.gltf",
            gltf.as_bytes(),
            &format!("keeps its data in another one, `{link}`, and no other file is opened"),
        );
    }
}
