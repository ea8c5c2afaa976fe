//! `PLY`: vertices of a PLY file as a point cloud; text, little-endian or big-endian.

use crate::cloud::survey::spacing_m;
use crate::cloud::table::{Columns, not_applied};
use crate::cloud::{CloudBuilder, CloudOptions, town_of};
use crate::coloured_point::ColouredPoint;
use crate::scalar::Scalar;
use crate::way_out::or_advice;
use cosfly_diagnose::counted;
use cosfly_domain::Town;
use cosfly_frames::DVec3;
use cosfly_town::remarks::speaks_of_a_place;
use cosfly_town::{MapError, MapFormat};

/// Takes a function from columns to the numbers of a row.
type VisitRow<'a> = &'a mut dyn FnMut(&dyn Fn(usize) -> f64);

/// Longest head, bytes.
const LONGEST_HEAD: usize = 64 << 10;
/// Vertices of faces farther apart than this are corners of a drawing, not a scan, metres.
const WIDEST_SPACING_M: f64 = 1.0;
const END: &[u8] = b"end_header";

/// The way out of a damaged file.
const WAY_OUT: &str =
    "the file seems to be damaged: fetch it again, or export the cloud as PLY with CloudCompare or Open3D";

/// The format `PLY`.
#[derive(Clone, Copy, Debug)]
pub struct Ply;

impl MapFormat for Ply {
    type Options = CloudOptions;

    const NAME: &'static str = "PLY";

    const EXAMPLE: &'static [u8] = include_bytes!("cloud/example.ply");

    fn recognises(head: &[u8]) -> bool {
        head.starts_with(b"ply\n") || head.starts_with(b"ply\r\n")
    }

    fn read(bytes: &[u8], options: &CloudOptions) -> Result<(Town, Vec<String>), MapError> {
        or_advice(town(bytes, options), WAY_OUT)
    }
}

fn town(bytes: &[u8], options: &CloudOptions) -> Result<(Town, Vec<String>), MapError> {
    let (text, data) = split(bytes)?;
    let head = Head::read(&text)?;
    let is_of_splats =
        ["f_dc_0", "scale_0", "rot_0"].iter().all(|name| head.properties.iter().any(|own| own.0 == *name));
    if is_of_splats && !options.splats_as_points {
        let error = MapError::new("the file holds Gaussian splats: their middles are no measured points");
        return Err(error
            .hint("name a mesh or a cloud of the place as the map, and this file in stage `render`: `splats = { source = ... }`")
            .hint("`options.splats_as_points = true` takes the middles as points; the dataset's card says so"));
    }
    if head.properties.iter().any(|own| own.0 == "packed_position") {
        let error =
            MapError::new("the file holds Gaussian splats that are packed, as SuperSplat packs them: they are no map");
        return Err(error
            .hint("name a mesh or a cloud of the place as the map; `npx @playcanvas/splat-transform packed.ply plain.ply` unpacks the splats for stage `render`"));
    }
    let columns = Columns::find(head.properties.iter().map(|(name, _)| name.as_str()))?;
    let unit_m = options.unit_m.unwrap_or(1.0);
    let mut cloud = CloudBuilder::new(options.up_axis);
    match head.encoding {
        Encoding::Text => head.each_line(data, columns.last(), &mut |value| columns.push(&mut cloud, unit_m, value))?,
        Encoding::Binary { is_big_endian } => {
            head.each_row(data, is_big_endian, &mut |value| columns.push(&mut cloud, unit_m, value))?;
        }
    }
    let mut cloud = columns.finish(cloud, options.unit_m)?;
    let remarks = text.lines().filter(|line| ["comment ", "obj_info "].iter().any(|word| line.starts_with(word)));
    cloud.warnings.extend(remarks.filter(|line| speaks_of_a_place(line)).map(not_applied));
    let spacing_m = spacing_m(&cloud);
    if head.has_faces && spacing_m > WIDEST_SPACING_M {
        let message = format!("the file is a mesh: its vertices, {spacing_m:.1} m apart, are no cloud of points");
        return Err(MapError::new(message).hint("export the mesh as GLB or OBJ"));
    }
    let (mut town, mut warnings) = town_of(cloud, options)?;
    if is_of_splats {
        let note = "the geometry is that of the middles of Gaussian splats, which are no measured points";
        town.synthetic.notes.push(note.to_owned());
        warnings.push(format!("{note}: clearances are not those of the place"));
    }
    if head.has_faces {
        warnings.push("the file has faces: only its vertices are read, as points".to_owned());
    }
    Ok((town, warnings))
}

/// Vertices with their colours.
pub(crate) fn coloured(bytes: &[u8]) -> Result<Vec<ColouredPoint>, MapError> {
    let (text, data) = split(bytes)?;
    let head = Head::read(&text)?;
    let column = |names: &[&str]| {
        let found = head.properties.iter().position(|(name, _)| names.iter().any(|own| name.eq_ignore_ascii_case(own)));
        found.ok_or_else(|| {
            let error = MapError::new(format!("the points have no number called `{}`", names[0]));
            error.hint("export the cloud with colours: `red`, `green` and `blue` of each point")
        })
    };
    let position = [column(&["x"])?, column(&["y"])?, column(&["z"])?];
    let colour = [column(&["red", "r"])?, column(&["green", "g"])?, column(&["blue", "b"])?];
    // Reals count to 1, longer numbers to 65,535.
    let most = colour.map(|column| match head.properties[column].1 {
        Scalar::Real(_) => 1.0,
        Scalar::Unsigned(2) | Scalar::Signed(2) => 65_535.0,
        _ => 255.0,
    });
    let last = position.into_iter().chain(colour).max().unwrap_or(0);
    let mut points = Vec::new();
    let mut push = |value: &dyn Fn(usize) -> f64| {
        let share = |k: usize| (255.0 * (value(colour[k]) / most[k]).clamp(0.0, 1.0) + 0.5) as u8;
        points.push(ColouredPoint {
            position: DVec3::from_array(position.map(value)),
            colour: [share(0), share(1), share(2)],
        });
    };
    match head.encoding {
        Encoding::Text => head.each_line(data, last, &mut push)?,
        Encoding::Binary { is_big_endian } => head.each_row(data, is_big_endian, &mut push)?,
    }
    Ok(points)
}

/// The head as text and the bytes behind it.
fn split(bytes: &[u8]) -> Result<(String, &[u8]), MapError> {
    let within = &bytes[..bytes.len().min(LONGEST_HEAD)];
    // A comment may hold the word, too: it must begin a line.
    let begins = |at: &usize| within[*at..].starts_with(END) && (*at == 0 || within[*at - 1] == b'\n');
    let at = (0..within.len()).find(begins);
    let line_end = at.and_then(|at| Some((at, at + within[at..].iter().position(|byte| *byte == b'\n')?)));
    let Some((at, line_end)) = line_end else {
        let error = MapError::new("the head of the file does not end with `end_header`");
        return Err(error.hint("the file seems to be cut off: fetch or export it again"));
    };
    Ok((String::from_utf8_lossy(&bytes[..at]).into_owned(), &bytes[line_end + 1..]))
}

#[derive(Clone, Copy, Debug)]
enum Encoding {
    Text,
    Binary { is_big_endian: bool },
}

/// An element of the head.
struct Element {
    name: String,
    count: usize,
    properties: Vec<(String, Property)>,
}

/// Property that a row holds under a name.
#[derive(Clone, Copy, Debug)]
enum Property {
    Number(Scalar),
    /// A number of items, and the items.
    List(Scalar, Scalar),
}

#[derive(Debug)]
struct Head {
    encoding: Encoding,
    /// Numbers of a vertex.
    properties: Vec<(String, Scalar)>,
    vertices: usize,
    /// Rows of the elements before the vertices, and what each holds.
    before: Vec<(usize, Vec<Property>)>,
    has_faces: bool,
}

/// Encoding and elements of a head, in their order.
fn elements(text: &str) -> Result<(Option<Encoding>, Vec<Element>), MapError> {
    let refusal = |at: usize, line: &str, rule: &str| {
        let shown: String = line.chars().take(60).collect();
        MapError::new(format!("line {} of the head is `{shown}`; {rule}", at + 1))
    };
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    for (at, line) in text.lines().enumerate().skip(1) {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["format", ..] if encoding.is_some() => {
                return Err(refusal(at, line, "there is a line `format` before"));
            }
            ["format", name, _] => {
                encoding = Some(match name {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::Binary { is_big_endian: false },
                    "binary_big_endian" => Encoding::Binary { is_big_endian: true },
                    _ => {
                        return Err(refusal(
                            at,
                            line,
                            "known are `ascii`, `binary_little_endian`, `binary_big_endian`",
                        ));
                    }
                });
            }
            ["element", name, _] if elements.iter().any(|element| element.name == name) => {
                return Err(refusal(at, line, "there is an element of that name before"));
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| refusal(at, line, "the count must be a whole number"))?;
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", ref kind @ .., name] => {
                let known =
                    |kind: &str| scalar(kind).ok_or_else(|| refusal(at, line, "the type of the number is unknown"));
                let property = match kind {
                    [kind] => Property::Number(known(kind)?),
                    ["list", count, item] => Property::List(known(count)?, known(item)?),
                    _ => return Err(refusal(at, line, "a property has a type and a name, or is a `list`")),
                };
                let element = elements.last_mut().ok_or_else(|| refusal(at, line, "no `element` comes before it"))?;
                element.properties.push((name.to_owned(), property));
            }
            [] | ["comment" | "obj_info", ..] => {}
            _ => return Err(refusal(at, line, "known are `format`, `element`, `property` and `comment`")),
        }
    }
    Ok((encoding, elements))
}

impl Head {
    fn read(text: &str) -> Result<Self, MapError> {
        let (encoding, elements) = elements(text)?;
        let encoding = encoding.ok_or_else(|| MapError::new("the head has no line `format`"))?;
        let at = elements.iter().position(|element| element.name == "vertex");
        let at = at.ok_or_else(|| MapError::new("the file has no element `vertex`"))?;
        let has_faces = elements.iter().any(|element| element.name == "face" && element.count > 0);
        let mut elements = elements.into_iter();
        let before = elements
            .by_ref()
            .take(at)
            .map(|element| (element.count, element.properties.into_iter().map(|(_, property)| property).collect()));
        let before: Vec<(usize, Vec<Property>)> = before.collect();
        let Element { count: vertices, properties, .. } =
            elements.next().ok_or_else(|| MapError::new("the file has no element `vertex`"))?;
        let number = |(name, property): (String, Property)| match property {
            Property::Number(scalar) => Ok((name, scalar)),
            Property::List(..) => {
                let error = MapError::new(format!("`{name}` of `vertex` is a list; a corner has numbers only"));
                Err(error.hint("export the cloud without lists at its vertices"))
            }
        };
        let properties = properties.into_iter().map(number).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { encoding, properties, vertices, before, has_faces })
    }

    fn cut_off(&self) -> MapError {
        let error = MapError::new(format!("the file ends before the last of {} vertices", self.vertices));
        error.hint("the file seems to be cut off: fetch or export it again")
    }

    /// Visits the rows of a binary file: `visit` takes a function from columns to numbers.
    fn each_row(&self, mut data: &[u8], is_big_endian: bool, visit: VisitRow<'_>) -> Result<(), MapError> {
        for (count, properties) in &self.before {
            data = without_rows(data, *count, properties, is_big_endian).ok_or_else(|| self.cut_off())?;
        }
        let row_bytes = row_bytes(&self.properties);
        let length = self.vertices.checked_mul(row_bytes).ok_or_else(|| self.cut_off())?;
        let rows = data.get(..length).ok_or_else(|| self.cut_off())?;
        let places: Vec<(usize, Scalar)> = self
            .properties
            .iter()
            .scan(0, |next, (_, scalar)| {
                let place = *next;
                *next += scalar.bytes();
                Some((place, *scalar))
            })
            .collect();
        for row in rows.chunks_exact(row_bytes) {
            let value = |column: usize| {
                let (place, scalar) = places[column];
                scalar.read(&row[place..], is_big_endian).unwrap_or(f64::NAN)
            };
            visit(&value);
        }
        Ok(())
    }

    /// [`Self::each_row`] of a text up to its column `last`.
    fn each_line(&self, data: &[u8], last: usize, visit: VisitRow<'_>) -> Result<(), MapError> {
        let text = String::from_utf8_lossy(data);
        let skipped = self.before.iter().map(|(count, _)| *count).fold(0, usize::saturating_add);
        let mut lines = text.lines().filter(|line| !line.trim().is_empty()).skip(skipped);
        let mut numbers = Vec::new();
        for vertex in 0..self.vertices {
            let line = lines.next().ok_or_else(|| self.cut_off())?;
            numbers.clear();
            numbers.extend(line.split_whitespace().take(last + 1).map_while(|word| word.parse::<f64>().ok()));
            if numbers.len() <= last {
                let shown: String = line.chars().take(60).collect();
                let rule = format!("it must have {}", counted(self.properties.len(), "number"));
                return Err(MapError::new(format!("vertex {vertex} is `{shown}`; {rule}")));
            }
            visit(&|column| numbers[column]);
        }
        Ok(())
    }
}

/// Bytes behind some rows; none where there are fewer.
fn without_rows<'d>(
    mut data: &'d [u8],
    count: usize,
    properties: &[Property],
    is_big_endian: bool,
) -> Option<&'d [u8]> {
    let numbers = properties.iter().map(|property| match property {
        Property::Number(scalar) => Some(scalar.bytes()),
        Property::List(..) => None,
    });
    if let Some(bytes) = numbers.sum::<Option<usize>>() {
        return data.get(count.checked_mul(bytes)?..);
    }
    for property in (0..count).flat_map(|_| properties) {
        let length = match property {
            Property::Number(scalar) => scalar.bytes(),
            Property::List(count, item) => {
                let items = count.read(data, is_big_endian)?;
                count.bytes().checked_add(item.bytes().checked_mul(items as usize)?)?
            }
        };
        data = data.get(length..)?;
    }
    Some(data)
}

fn row_bytes(properties: &[(String, Scalar)]) -> usize {
    properties.iter().map(|(_, scalar)| scalar.bytes()).sum()
}

fn scalar(name: &str) -> Option<Scalar> {
    Some(match name {
        "char" | "int8" => Scalar::Signed(1),
        "uchar" | "uint8" => Scalar::Unsigned(1),
        "short" | "int16" => Scalar::Signed(2),
        "ushort" | "uint16" => Scalar::Unsigned(2),
        "int" | "int32" => Scalar::Signed(4),
        "uint" | "uint32" => Scalar::Unsigned(4),
        "float" | "float32" => Scalar::Real(4),
        "double" | "float64" => Scalar::Real(8),
        _ => return None,
    })
}
