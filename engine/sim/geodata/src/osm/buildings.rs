//! Buildings and their parts as boxes.

use super::elements::{CUT_OUT, Elements, Relation, Role, Way};
use super::frame::Frame;
use super::heights::{heights, rectangle_around};
use super::options::OsmOptions;
use super::passages::Passages;
use super::rings::{Area, Problems, Source, areas, closes};
use super::stated::Doubts;
use super::tags::Tags;
use super::tally::Tally;
use crate::slabs::inner_point;
use cosfly_domain::{Obstacle, ObstacleKind};
use cosfly_frames::DVec2;
use cosfly_town::MapError;
use cosfly_town::polygons::PolygonIndex;
use cosfly_town::solids::{CoarseThings, Footprint, building_boxes, layer_boxes};
use std::collections::{BTreeMap, BTreeSet};

/// Buildings farther outside the stated bounds are left out, metres.
const MARGIN_M: f64 = 1000.0;
/// Share of an outline that its parts must cover to replace it.
const REPLACING_SHARE: f64 = 0.5;
/// Places along each side of an outline where its parts are looked for.
const SAMPLES: usize = 16;
/// Most boxes of one town.
pub const MOST_BOXES: usize = 2_000_000;

/// The buildings of an extract.
#[derive(Debug, Default)]
pub struct Buildings {
    /// Their boxes.
    pub obstacles: Vec<Obstacle>,
    /// Outlines, and parts that lie in none.
    pub count: usize,
    /// Parts.
    pub parts: usize,
    /// Whole outlines that gave way to their parts.
    pub replaced: usize,
    /// Buildings and parts of default height.
    pub of_default_height: usize,
    /// Buildings and parts whose roof's rise is a guess.
    pub of_guessed_rise: usize,
    /// Lines with the tags of a building that do not close.
    pub open: Tally,
    /// Left out because they lie under the ground.
    pub hidden: usize,
    /// Those whose boxes are coarser than they should be.
    pub coarse: CoarseThings,
    /// Left out because they lie far outside the bounds.
    pub far: Tally,
}

/// Values of `building` of what is no building, or not yet, or not any more.
const NOT_THERE: &[&str] = &["proposed", "planned", "demolished", "destroyed", "razed", "removed", "underground"];

fn is_outline(tags: &Tags) -> bool {
    tags.has("building") && !tags.is("building", NOT_THERE)
}

fn is_part(tags: &Tags) -> bool {
    tags.has("building:part")
}

/// Reads all buildings; `next_id` numbers the objects from there on.
///
/// # Errors
/// More boxes than any town has.
pub fn read(
    elements: &Elements,
    frame: &Frame,
    options: &OsmOptions,
    passages: &mut Passages,
    next_id: &mut u32,
    problems: &mut Problems,
) -> Result<Buildings, MapError> {
    let mut out = Buildings::default();
    let outlines = out.kept(areas(elements, frame, is_outline, problems), frame);
    // A ring that is outline and part at once is told of once.
    let parts = out.kept(areas(elements, frame, is_part, &mut Problems::default()), frame);
    let parents = parents(elements, &outlines, &parts);
    let mut parts_of: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (part, parent) in parents.iter().enumerate() {
        if let Some(parent) = parent {
            parts_of.entry(*parent).or_default().push(part);
        }
    }
    let doubts = &mut problems.doubts;
    for (index, outline) in outlines.iter().enumerate() {
        let own: Vec<&Area<'_>> = parts_of.get(&index).into_iter().flatten().map(|part| &parts[*part]).collect();
        let id = out.next(next_id);
        if covered_share(outline, &own) >= REPLACING_SHARE {
            out.replaced += 1;
        } else {
            out.add(outline, id, options, passages, doubts)?;
        }
        for part in own {
            out.add(part, id, options, passages, doubts)?;
        }
    }
    for (part, _) in parts.iter().zip(&parents).filter(|(_, parent)| parent.is_none()) {
        let id = out.next(next_id);
        out.add(part, id, options, passages, doubts)?;
    }
    out.parts = parts.len();
    let members: BTreeSet<i64> = elements
        .relations
        .iter()
        .flat_map(|relation| &relation.members)
        .filter(|member| member.is_way)
        .map(|member| member.id)
        .collect();
    let is_open = |way: &&Way| {
        (is_outline(&way.tags) || is_part(&way.tags)) && !members.contains(&way.id) && !closes(elements, frame, way)
    };
    elements.ways.iter().filter(is_open).for_each(|way| out.open.add(Source::Way(way.id)));
    Ok(out)
}

impl Buildings {
    fn next(&mut self, next_id: &mut u32) -> u32 {
        self.count += 1;
        *next_id += 1;
        *next_id
    }

    fn kept<'e>(&mut self, areas: Vec<Area<'e>>, frame: &Frame) -> Vec<Area<'e>> {
        let mut kept = Vec::with_capacity(areas.len());
        for area in areas {
            if area.tags.is("location", &["underground"]) || area.tags.is_below() {
                self.hidden += 1;
            } else if area.outer.iter().any(|corner| frame.holds(*corner, MARGIN_M)) {
                kept.push(area);
            } else {
                self.far.add(area.source);
            }
        }
        kept
    }

    fn add(
        &mut self,
        area: &Area<'_>,
        object_id: u32,
        options: &OsmOptions,
        passages: &mut Passages,
        doubts: &mut Doubts,
    ) -> Result<(), MapError> {
        let sides = rectangle_around(&area.outer);
        let heights = heights(area.tags, sides, options, area.source, doubts);
        self.of_default_height += usize::from(heights.is_default);
        self.of_guessed_rise += usize::from(heights.is_rise_guessed);
        let footprint = Footprint { outer: area.outer.clone(), holes: area.holes.clone() };
        let mut base_m = heights.base_m;
        let mut solids = Vec::new();
        for layer in passages.layers(area, heights.base_m, heights.eaves_m) {
            solids.extend(layer.regions.iter().map(|region| layer_boxes(region, layer.base_m, layer.top_m)));
            base_m = layer.top_m;
        }
        solids.push(building_boxes(&footprint, base_m, heights.eaves_m, heights.roof));
        solids.iter().for_each(|solid| self.coarse.add(solid));
        self.obstacles.extend(solids.into_iter().flat_map(|solid| solid.boxes).map(|shape| Obstacle {
            shape,
            kind: ObstacleKind::Building,
            object_id,
            synthetic: false,
        }));
        check_count(self.obstacles.len(), area.source)
    }
}

/// # Errors
/// More boxes than any town has.
fn check_count(boxes: usize, source: Source) -> Result<(), MapError> {
    if boxes <= MOST_BOXES {
        return Ok(());
    }
    Err(MapError::new(format!("the file gives more than {MOST_BOXES} solid boxes (at {source})")).hint(CUT_OUT))
}

/// The outline that each part belongs to: by a relation of type `building`, else by its place.
fn parents(elements: &Elements, outlines: &[Area<'_>], parts: &[Area<'_>]) -> Vec<Option<usize>> {
    let stated = stated_parents(elements);
    let outline_of: BTreeMap<Source, usize> =
        outlines.iter().enumerate().map(|(index, outline)| (outline.source, index)).collect();
    let index = PolygonIndex::new(outlines.iter().map(|outline| outline.outer.clone()).collect());
    let parent = |part: &Area<'_>| {
        let by_relation = stated.get(&part.source).and_then(|outline| outline_of.get(outline));
        by_relation.copied().or_else(|| {
            let point = inner_point(&part.rings())?;
            index.at(point).find(|outline| outlines[*outline].contains(point))
        })
    };
    parts.iter().map(parent).collect()
}

/// Outlines of parts as relations of type `building` state them.
fn stated_parents(elements: &Elements) -> BTreeMap<Source, Source> {
    let mut stated = BTreeMap::new();
    for relation in elements.relations.iter().filter(|relation| relation.tags.is("type", &["building"])) {
        let Some(outline) = sources(relation, Role::Outline).next() else { continue };
        stated.extend(sources(relation, Role::Part).map(|part| (part, outline)));
    }
    stated
}

fn sources(relation: &Relation, role: Role) -> impl Iterator<Item = Source> {
    let members = relation.members.iter().filter(move |member| member.role == role);
    members.map(|member| if member.is_way { Source::Way(member.id) } else { Source::Relation(member.id) })
}

/// Share of an outline under its parts, on a grid of samples.
fn covered_share(outline: &Area<'_>, parts: &[&Area<'_>]) -> f64 {
    if parts.is_empty() {
        return 0.0;
    }
    let low = outline.outer.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = outline.outer.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let (mut inside, mut covered) = (0_usize, 0_usize);
    for cell in 0..SAMPLES * SAMPLES {
        let share = DVec2::new((cell % SAMPLES) as f64 + 0.5, (cell / SAMPLES) as f64 + 0.5) / SAMPLES as f64;
        let point = low + share * (high - low);
        if outline.contains(point) {
            inside += 1;
            covered += usize::from(parts.iter().any(|part| part.contains(point)));
        }
    }
    covered as f64 / inside.max(1) as f64
}
