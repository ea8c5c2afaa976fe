//! Writes the example files of the formats of meshes: `write_meshes` from the repository's root.
//!
//! All show one scene, z up, metres: a lawn, a pavement, a house with an annex, a tree, a bench without a telling name.

/// A mesh with its name.
pub struct Mesh {
    /// Name of the node or group.
    pub name: &'static str,
    /// Corners.
    pub vertices: Vec<[f64; 3]>,
    /// Faces.
    pub triangles: Vec<[u32; 3]>,
}

/// A prism over an outline (counter-clockwise), with its floor and its top.
pub fn prism(name: &'static str, outline: &[[f64; 2]], base: f64, top: f64, cap: &[[u32; 3]]) -> Mesh {
    let count = outline.len() as u32;
    let vertices = [base, top].into_iter().flat_map(|z| outline.iter().map(move |[x, y]| [*x, *y, z])).collect();
    let walls = (0..count).flat_map(|i| {
        let next = (i + 1) % count;
        [[i, next, count + next], [i, count + next, count + i]]
    });
    let floor = cap.iter().map(|[a, b, c]| [*a, *c, *b]);
    let roof = cap.iter().map(|corners| corners.map(|corner| corner + count));
    Mesh { name, vertices, triangles: walls.chain(floor).chain(roof).collect() }
}

fn quad(name: &'static str, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], z: f64) -> Mesh {
    Mesh {
        name,
        vertices: vec![[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// Outline of the house with its annex: an L.
pub const HOUSE: [[f64; 2]; 6] = [[0.0, 0.0], [20.0, 0.0], [20.0, 6.0], [6.0, 6.0], [6.0, 15.0], [0.0, 15.0]];
/// Triangles of the outline.
pub const HOUSE_CAP: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];

/// The scene.
pub fn scene() -> Vec<Mesh> {
    let square = |[x, y]: [f64; 2], half: f64| {
        [[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]]
    };
    const SQUARE: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
    vec![
        quad("lawn_grass", [-40.0, -40.0], [40.0, 40.0], 0.0),
        quad("Sidewalk_1", [-40.0, -12.0], [40.0, -6.0], 0.15),
        prism("House", &HOUSE, 0.0, 9.0, &HOUSE_CAP),
        prism("oak_trunk", &square([-20.0, 10.0], 0.3), 0.0, 3.0, &SQUARE),
        prism("oak_crown", &square([-20.0, 10.0], 2.5), 2.5, 8.0, &SQUARE),
        prism("Cube.001", &square([-10.0, -15.0], 0.6), 0.0, 0.5, &SQUARE),
    ]
}

/// A point of the scene with y up.
fn y_up([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, z, -y]
}

/// An OBJ file, y up: first all faces, then all corners, so that a file that is cut off lacks some.
pub fn obj(meshes: &[Mesh]) -> Vec<u8> {
    let mut out = String::new();
    let mut first = 1;
    for mesh in meshes {
        out += &format!("o {}\n", mesh.name);
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|corner| corner + first);
            out += &format!("f {a} {b} {c}\n");
        }
        first += mesh.vertices.len() as u32;
    }
    for [x, y, z] in meshes.iter().flat_map(|mesh| &mesh.vertices).map(|vertex| y_up(*vertex)) {
        out += &format!("v {x} {y} {z}\n");
    }
    out.into_bytes()
}

/// A GLB file, y up: a node for each mesh, corners as 32-bit reals, faces as 16-bit numbers.
pub fn glb(meshes: &[Mesh]) -> Vec<u8> {
    let (mut data, mut views, mut accessors, mut nodes, mut own) = (Vec::new(), vec![], vec![], vec![], vec![]);
    for (at, mesh) in meshes.iter().enumerate() {
        let start = data.len();
        let vertices: Vec<[f32; 3]> =
            mesh.vertices.iter().map(|vertex| y_up(*vertex).map(|number| number as f32)).collect();
        data.extend(vertices.iter().flatten().flat_map(|number| number.to_le_bytes()));
        views.push(format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":{}}}"#, data.len() - start));
        let bound = |pick: fn(f32, f32) -> f32| {
            let bound =
                (0..3).map(|axis| vertices.iter().map(|vertex| vertex[axis]).reduce(pick).unwrap_or(0.0).to_string());
            bound.collect::<Vec<_>>().join(",")
        };
        let (low, high) = (bound(f32::min), bound(f32::max));
        accessors.push(format!(
            r#"{{"bufferView":{},"componentType":5126,"count":{},"type":"VEC3","min":[{low}],"max":[{high}]}}"#,
            2 * at,
            vertices.len()
        ));
        let start = data.len();
        data.extend(mesh.triangles.iter().flatten().flat_map(|corner| (*corner as u16).to_le_bytes()));
        views.push(format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":{}}}"#, data.len() - start));
        let count = 3 * mesh.triangles.len();
        accessors
            .push(format!(r#"{{"bufferView":{},"componentType":5123,"count":{count},"type":"SCALAR"}}"#, 2 * at + 1));
        data.resize(data.len().next_multiple_of(4), 0);
        nodes.push(format!(r#"{{"name":"{}","mesh":{at}}}"#, mesh.name));
        own.push(format!(r#"{{"primitives":[{{"attributes":{{"POSITION":{}}},"indices":{}}}]}}"#, 2 * at, 2 * at + 1));
    }
    let roots = (0..meshes.len()).map(|at| at.to_string()).collect::<Vec<_>>().join(",");
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{roots}]}}],"nodes":[{}],"meshes":[{}],"accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}}"#,
        nodes.join(","),
        own.join(","),
        accessors.join(","),
        views.join(","),
        data.len()
    )
    .into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8; 4], content: &[u8]| [&(content.len() as u32).to_le_bytes(), &kind[..], content].concat();
    let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &data)].concat();
    let size = (12 + chunks.len()) as u32;
    [&b"glTF"[..], &2_u32.to_le_bytes(), &size.to_le_bytes(), &chunks].concat()
}

/// Places of the example files, and their content.
pub fn files() -> Vec<(&'static str, Vec<u8>)> {
    vec![("src/mesh/example.glb", glb(&scene())), ("src/mesh/example.obj", obj(&scene()))]
}

fn main() -> std::io::Result<()> {
    for (path, bytes) in files() {
        std::fs::write(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path), bytes)?;
    }
    Ok(())
}
