//! [`recognise`]: the format of a file by its beginning, or the way from a format that is not read to one that is.

use crate::FORMATS;
use cosfly_town::{Format, MapError};

/// Whether a file of this beginning is of some format.
type IsIt = fn(&[u8]) -> bool;

/// Formats that are not read, by the beginnings of their files, and the way to one that is.
const RELATIVES: &[(IsIt, &str)] = &[
    (|head| head.starts_with(b"BZh"), "the file is packed by bzip2: unpack it with `bunzip2`"),
    (|head| head.starts_with(b"PK\x03\x04"), "the file is a ZIP archive: unpack it"),
    (
        |head| head.starts_with(&[0x1f, 0x8b]),
        "the file is packed by gzip: unpack it with `gunzip`; splats (`.spz`) are no map but `splats.source` of stage `render`, over a map of \
         the same place",
    ),
    (
        |head| holds(head, "<net ") && (holds(head, "<location") || holds(head, "net_file.xsd")),
        "the file is a net of SUMO: `netconvert -s FILE --opendrive-output town.xodr` makes OpenDRIVE of it",
    ),
    (|head| holds(head, "CityModel"), "the file is CityGML: `citygml-tools to-cityjson FILE` makes CityJSON of it"),
    (
        |head| holds(head, "<osmChange"),
        "the file has changes of OpenStreetMap: `osmium apply-changes` puts them into an extract",
    ),
    (|head| holds(head, "Overpass"), "ask Overpass for `[out:xml]`, with all nodes: `(._;>;); out;`"),
    (
        |head| holds(head, "\"FeatureCollection\""),
        "the file is GeoJSON: take an extract of OpenStreetMap, or CityJSON, of the same place",
    ),
    (
        |head| is_tile(head) || holds(head, "\"geometricError\""),
        "the file is of 3D Tiles: `cosfly map tiles tileset.json --out scan.glb` joins the tiles to one mesh",
    ),
    (|head| head.starts_with(b"ISO-10303-21"), "the file is IFC: export it as GLB, OBJ or CityJSON"),
    (
        |head| head.starts_with(b"Kaydara FBX") || holds(head, "<COLLADA"),
        "open the file in Blender and export it as GLB",
    ),
    (
        is_stl,
        "the file is STL, which has no names of things: open it in Blender, name its parts and export it as GLB or OBJ",
    ),
    (|head| head.starts_with(b"ASTM-E57"), "the file is E57: `pdal translate FILE cloud.laz` makes LAZ of it"),
    (|head| head.starts_with(b"NGSP") || is_splats(head), SPLATS),
    (
        is_scan,
        "the file seems to be a scan as KITTI has them, four 32-bit numbers a point, or five as in nuScenes: put a head of PLY before \
         its bytes, with `format binary_little_endian 1.0`, `element vertex N` (its bytes by 16, or by 20) and a `property float` \
         for each number, the first three x, y, z",
    ),
    (
        is_table_of_points,
        "the file seems to be a table of points: put a head of PLY before its rows, with `format ascii 1.0`, `element vertex N` \
         (its rows) and a `property double` for each column, the first three x, y, z",
    ),
];

const SPLATS: &str = "the file holds Gaussian splats (`.splat`, `.spz`): they are no map but `splats.source` of stage `render`, over a map of the same \
     place; of `.ply` files the map takes the middles with `options.splats_as_points = true`";

/// Splats of 32 bytes each: a place, three lengths, a colour, and a turn of length one.
fn is_splats(head: &[u8]) -> bool {
    let is_splat = |own: &[u8; 32]| {
        let mut numbers = floats(&own[..24]);
        let is_place = numbers.by_ref().take(3).all(|it| it == 0.0 || (1e-9..1e6).contains(&it.abs()));
        let turn: f32 = own[28..].iter().map(|part| ((f32::from(*part) - 128.0) / 128.0).powi(2)).sum();
        is_place && numbers.all(|it| (0.0..1e4).contains(&it)) && (0.9..1.1).contains(&turn)
    };
    let splats = head.as_chunks::<32>().0;
    !splats.is_empty() && splats.iter().all(is_splat)
}

fn is_tile(head: &[u8]) -> bool {
    [b"b3dm", b"i3dm", b"pnts", b"cmpt"].iter().any(|magic| head.starts_with(*magic))
}

fn holds(head: &[u8], word: &str) -> bool {
    head.windows(word.len()).any(|window| window == word.as_bytes())
}

/// Meshes of triangles as text, or as 50 bytes each whose last two are 0 behind a head of 80 bytes and a count.
fn is_stl(head: &[u8]) -> bool {
    let is_text = head.trim_ascii_start().starts_with(b"solid") && holds(head, "facet");
    let count = head.get(80..84).and_then(|bytes| Some(u32::from_le_bytes(*bytes.first_chunk()?)));
    let mut facets = head.get(84..).unwrap_or_default().chunks_exact(50);
    let is_facet = |facet: &[u8]| facet[48..] == [0, 0] && floats(&facet[..48]).all(|it| it.abs() < 1e7);
    is_text || count.is_some_and(|count| (1..100_000_000).contains(&count)) && facets.len() > 0 && facets.all(is_facet)
}

/// Points of a laser scanner: metres around it, a share of reflected light, and in some sets the number of the beam.
fn is_scan(head: &[u8]) -> bool {
    let is_point = |point: &[u8]| {
        let mut numbers = floats(point);
        let is_place = numbers.by_ref().take(3).all(|it| it == 0.0 || (1e-6..500.0).contains(&it.abs()));
        is_place && numbers.all(|it| (0.0..=255.0).contains(&it))
    };
    [16, 20].into_iter().any(|bytes| head.len() >= 4 * bytes && head.chunks_exact(bytes).all(is_point))
}

fn floats(bytes: &[u8]) -> impl Iterator<Item = f32> + '_ {
    bytes.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]))
}

/// Rows of three numbers or more between white space.
fn is_table_of_points(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    // The last line may be cut.
    let whole = text.rsplit_once('\n').map_or("", |(whole, _)| whole);
    let mut rows = whole.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')).peekable();
    let is_row = |line: &str| {
        let numbers = line.split_whitespace().take_while(|word| word.parse::<f64>().is_ok()).count();
        numbers >= 3 && numbers == line.split_whitespace().count()
    };
    rows.peek().is_some() && rows.all(is_row)
}

/// The format of a file that begins with `head`; [`Format::HEAD_BYTES`] are enough.
///
/// # Errors
/// The file is empty or of no known format.
pub fn recognise(head: &[u8]) -> Result<&'static Format, MapError> {
    FORMATS.iter().find(|format| format.recognises(head)).ok_or_else(|| {
        let names: Vec<_> = FORMATS.iter().map(Format::name).collect();
        let message = if head.is_empty() { "the file is empty" } else { "the file is of no known map format" };
        let error = MapError::new(message).hint(format!("known formats: {}", names.join(", ")));
        let head = &head[..head.len().min(Format::HEAD_BYTES)];
        RELATIVES.iter().filter(|(is_it, _)| is_it(head)).fold(error, |error, (_, advice)| error.hint(*advice))
    })
}
