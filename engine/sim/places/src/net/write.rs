//! The network and what stands beside it as OpenDRIVE 1.6 text.

use super::network::{Arm, Network, Street};
use super::ways::Way;
use crate::relief::Relief;
use crate::things::{Footprint, GeneratedThing};
use crate::xml::{Foot, Lane, fixed, line, road_mark, write_crossing, write_lane, write_object, write_plan_view};
use cosfly_frames::DVec2;

/// Id of the first junction; streets count from 1.
const FIRST_JUNCTION: usize = 10_000;
/// Id of the first connecting road.
const FIRST_WAY: usize = 20_000;
/// Id of the road without lanes along which things on the land are listed.
const LAND: usize = 9_999;
/// Middle of a crossing from the mouth of its arm, its width along the street, and how far it reaches onto the
/// pavements, metres.
const CROSSING_M: [f64; 3] = [2.5, 3.0, 0.4];
/// Land beside the outermost streets that belongs to the place, metres.
const MARGIN_M: f64 = 150.0;

/// Everything; `name` becomes that of the town.
pub fn write_opendrive(
    network: &Network,
    ways: &[Way],
    things: &[GeneratedThing],
    [name, comment]: [&str; 2],
) -> String {
    let mut text = String::new();
    let [low, high] = reach(network.bounds(MARGIN_M), things);
    line(&mut text, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>");
    line(&mut text, &format!("<!-- {comment} -->"));
    line(&mut text, "<OpenDRIVE>");
    let [south, west, north, east] = [low.y, low.x, high.y, high.x].map(|edge| fixed(edge, 1));
    line(
        &mut text,
        &format!(
            "<header revMajor=\"1\" revMinor=\"6\" name=\"{name}\" version=\"1.00\" vendor=\"cosfly\" north=\"{north}\" south=\"{south}\" east=\"{east}\" west=\"{west}\"{}",
            if network.has_lawn { "><userData code=\"open_ground\" value=\"lawn\"/></header>" } else { "/>" }
        ),
    );
    for (index, street) in network.streets.iter().enumerate() {
        write_street(&mut text, index, street, network);
    }
    for (index, way) in ways.iter().enumerate() {
        write_way(&mut text, index, way, network);
    }
    write_land(&mut text, 2 * network.streets.len() + 1, things, network.relief, [low, high]);
    for junction in (0..network.junctions.len()).filter(|junction| network.has_ways(*junction)) {
        write_junction(&mut text, junction, ways, network);
    }
    line(&mut text, "</OpenDRIVE>");
    text
}

/// Bounds that hold the middles of all upright things, too: woods and gardens may reach beyond the margin.
fn reach([low, high]: [DVec2; 2], things: &[GeneratedThing]) -> [DVec2; 2] {
    let upright = things.iter().filter(|thing| !matches!(thing.footprint, Footprint::Polygon(_)));
    upright.map(|thing| thing.footprint.center()).fold([low, high], |[low, high], at| [low.min(at), high.max(at)])
}

fn begin_road(text: &mut String, [name, id, junction]: [&str; 3], length_m: f64) {
    let length_m = fixed(length_m, 9);
    line(text, &format!("<road name=\"{name}\" length=\"{length_m}\" id=\"{id}\" junction=\"{junction}\">"));
}

fn write_street(text: &mut String, index: usize, street: &Street, network: &Network) {
    let (length_m, profile) = (street.line.length_m(), street.profile);
    let id = (index + 1).to_string();
    begin_road(text, [&format!("street {id}"), &id, "-1"], length_m);
    let end = |(name, junction): (&str, usize)| {
        let id = FIRST_JUNCTION + junction;
        let link = format!("<{name} elementType=\"junction\" elementId=\"{id}\"/>");
        if network.has_ways(junction) { link } else { String::new() }
    };
    let [start, end] = [("predecessor", street.junctions[0]), ("successor", street.junctions[1])].map(end);
    line(text, &format!("<link>{start}{end}</link>"));
    line(text, "<type s=\"0\" type=\"town\"><speed max=\"50\" unit=\"km/h\"/></type>");
    write_plan_view(text, &street.line, &network.relief);
    let lanes = i64::from(profile.lanes);
    let lane = |id: i64| {
        let is_sidewalk = id.abs() == lanes + 1;
        let width_m = if is_sidewalk { profile.sidewalk_m } else { profile.lane_m };
        let mark = if is_sidewalk || profile.lane_m < 3.0 {
            "none"
        } else if id.abs() == lanes {
            "solid"
        } else {
            "broken"
        };
        Lane { id, is_sidewalk, width_m: [width_m; 2], links: None, mark }
    };
    let middle = match profile.lanes {
        _ if profile.lane_m < 3.0 => "none",
        1 => "broken",
        _ => "solid",
    };
    line(text, "<lanes><laneSection s=\"0\"><left>");
    (1..=lanes + 1).rev().for_each(|id| write_lane(text, &lane(id), length_m));
    let center = format!("<center><lane id=\"0\" type=\"none\" level=\"false\">{}</lane></center>", road_mark(middle));
    line(text, &format!("</left>{center}<right>"));
    (1..=lanes + 1).for_each(|id| write_lane(text, &lane(-id), length_m));
    line(text, "</right></laneSection></lanes><objects>");
    write_crossings(text, index, street, network);
    line(text, "</objects></road>");
}

/// A crossing at either end, but for the bends that are junctions of two arms.
fn write_crossings(text: &mut String, index: usize, street: &Street, network: &Network) {
    let [from_mouth_m, along_m, onto_pavement_m] = CROSSING_M;
    let reach_m = street.profile.carriageway_m() + onto_pavement_m;
    for (end, s_m) in [from_mouth_m, street.line.length_m() - from_mouth_m].into_iter().enumerate() {
        if network.junctions[street.junctions[end]].len() == 2 || !network.has_ways(street.junctions[end]) {
            continue;
        }
        write_crossing(text, 2 * index + end + 1, (&street.line, s_m), [along_m, reach_m], &network.relief);
    }
}

/// Lane ids that a way's lane `-lane` comes from and leads to.
fn links(way: &Way, lane: i64, network: &Network) -> [i64; 2] {
    let is_sidewalk = lane > i64::from(way.lanes);
    let of_arm = |arm: Arm, skipped: u32, inward: bool| {
        let sign = if arm.at_end == inward { -1 } else { 1 };
        let outermost = i64::from(network.profile(arm).lanes) + 1;
        sign * if is_sidewalk { outermost } else { i64::from(skipped) + lane }
    };
    [of_arm(way.arms[0], way.skipped_lanes[0], true), of_arm(way.arms[1], way.skipped_lanes[1], false)]
}

fn write_way(text: &mut String, index: usize, way: &Way, network: &Network) {
    let length_m = way.line.length_m();
    let [id, junction] = [FIRST_WAY + index, FIRST_JUNCTION + way.junction].map(|id| id.to_string());
    begin_road(text, [&format!("way {id}"), &id, &junction], length_m);
    let end = |name: &str, arm: Arm| {
        let contact = if arm.at_end { "end" } else { "start" };
        format!("<{name} elementType=\"road\" elementId=\"{}\" contactPoint=\"{contact}\"/>", arm.street + 1)
    };
    line(text, &format!("<link>{}{}</link>", end("predecessor", way.arms[0]), end("successor", way.arms[1])));
    line(text, "<type s=\"0\" type=\"town\"><speed max=\"30\" unit=\"km/h\"/></type>");
    write_plan_view(text, &way.line, &network.relief);
    let center = format!("<center><lane id=\"0\" type=\"none\" level=\"false\">{}</lane></center>", road_mark("none"));
    line(text, &format!("<lanes><laneSection s=\"0\">{center}<right>"));
    let lanes = i64::from(way.lanes);
    for lane in 1..=lanes + i64::from(way.sidewalk_m.is_some()) {
        let width_m = way.sidewalk_m.filter(|_| lane > lanes).unwrap_or(way.lane_m);
        let links = Some(links(way, lane, network));
        write_lane(text, &Lane { id: -lane, is_sidewalk: lane > lanes, width_m, links, mark: "none" }, length_m);
    }
    line(text, "</right></laneSection></lanes></road>");
}

/// A straight road without lanes from west to east, along which all things have their places: s is east, t north.
fn write_land(text: &mut String, first_id: usize, things: &[GeneratedThing], relief: Relief, [low, high]: [DVec2; 2]) {
    let (origin, length_m) = (DVec2::new(low.x.floor(), 0.0), (high.x - low.x).ceil() + 1.0);
    begin_road(text, ["land", &LAND.to_string(), "-1"], length_m);
    let (x, length_m) = (fixed(origin.x, 1), fixed(length_m, 1));
    line(
        text,
        &format!(
            "<planView><geometry s=\"0\" x=\"{x}\" y=\"0\" hdg=\"0\" length=\"{length_m}\"><line/></geometry></planView>"
        ),
    );
    line(
        text,
        "<lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\" level=\"false\"/></center></laneSection></lanes>",
    );
    line(text, "<objects>");
    for (index, thing) in things.iter().flat_map(|thing| relief.pieces(thing)).enumerate() {
        let at = match &thing.footprint {
            // Outlines are told from any point; that of the land's road must be on it.
            Footprint::Polygon(corners) => DVec2::new(corners[0].x.clamp(low.x, high.x), corners[0].y),
            footprint => footprint.center(),
        };
        let foot = Foot { s_m: at.x - origin.x, t_m: at.y, beyond_m: 0.0, origin: at, heading_rad: 0.0, relief };
        write_object(text, first_id + index, &thing, &foot);
    }
    line(text, "</objects></road>");
}

fn write_junction(text: &mut String, junction: usize, ways: &[Way], network: &Network) {
    let own = ways.iter().enumerate().filter(|(_, way)| way.junction == junction);
    line(text, &format!("<junction id=\"{0}\" name=\"junction {0}\">", FIRST_JUNCTION + junction));
    for (connection, (index, way)) in own.enumerate() {
        let lanes = i64::from(way.lanes) + i64::from(way.sidewalk_m.is_some());
        let links: String = (1..=lanes)
            .map(|lane| format!("<laneLink from=\"{}\" to=\"{}\"/>", links(way, lane, network)[0], -lane))
            .collect();
        let (incoming, connecting) = (way.arms[0].street + 1, FIRST_WAY + index);
        line(
            text,
            &format!(
                "<connection id=\"{connection}\" incomingRoad=\"{incoming}\" connectingRoad=\"{connecting}\" contactPoint=\"start\">{links}</connection>"
            ),
        );
    }
    line(text, "</junction>");
}
