//! The generated town as OpenDRIVE 1.6 text, floats with fixed decimals.

use super::streets::{Arm, LANE_WIDTH_M, Network, RoadEnd, Street};
use super::turns::JunctionWay;
use crate::relief::Relief;
use crate::things::GeneratedThing;
use crate::xml::{Foot, Lane, fixed, line, road_mark, write_crossing, write_lane, write_object, write_plan_view};
use cosfly_frames::DVec2;

/// Id of the first junction; streets count from 1.
const FIRST_JUNCTION: usize = 1000;
/// Id of the first connecting road.
const FIRST_TURN: usize = 2000;
/// Middle of a crossing from the mouth of its arm, its width along the street, and how far it reaches onto the
/// pavements, metres.
const CROSSING_M: [f64; 3] = [3.0, 3.0, 0.4];

/// Writes everything.
pub fn write_opendrive(network: &Network, turns: &[JunctionWay], things: &[GeneratedThing], comment: &str) -> String {
    let mut text = String::new();
    let (low, high) = network.outline();
    text.push_str("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    line(&mut text, &format!("<!-- {comment} -->"));
    line(&mut text, "<OpenDRIVE>");
    line(
        &mut text,
        &format!(
            "<header revMajor=\"1\" revMinor=\"6\" name=\"downtown\" version=\"1.00\" vendor=\"cosfly\" north=\"{}\" south=\"{}\" east=\"{}\" west=\"{}\"/>",
            fixed(high.y + 20.0, 1),
            fixed(low.y - 20.0, 1),
            fixed(high.x + 20.0, 1),
            fixed(low.x - 20.0, 1)
        ),
    );
    let objects = objects_by_street(network, things);
    for (index, street) in network.streets.iter().enumerate() {
        write_street(&mut text, index, street, &objects[index]);
    }
    for (index, turn) in turns.iter().enumerate() {
        write_turn(&mut text, index, turn, network);
    }
    for junction in 0..network.junctions.len() {
        write_junction(&mut text, junction, turns, network);
    }
    line(&mut text, "</OpenDRIVE>");
    text
}

fn write_street(text: &mut String, index: usize, street: &Street, objects: &str) {
    let length_m = street.line.length_m();
    let [start, end] = street.junctions.map(|junction| junction + FIRST_JUNCTION);
    line(
        text,
        &format!("<road name=\"street {0}\" length=\"{1}\" id=\"{0}\" junction=\"-1\">", index + 1, fixed(length_m, 9)),
    );
    line(
        text,
        &format!(
            "<link><predecessor elementType=\"junction\" elementId=\"{start}\"/><successor elementType=\"junction\" elementId=\"{end}\"/></link>"
        ),
    );
    line(text, "<type s=\"0\" type=\"town\"><speed max=\"50\" unit=\"km/h\"/></type>");
    write_plan_view(text, &street.line, &Relief::default());
    line(text, "<lanes><laneSection s=\"0\">");
    let lanes = i64::from(street.profile.lanes);
    let lane = |id: i64| {
        let is_sidewalk = id.abs() == lanes + 1;
        let width_m = if is_sidewalk { street.profile.sidewalk_m } else { LANE_WIDTH_M };
        let mark = if is_sidewalk {
            "none"
        } else if id.abs() == lanes {
            "solid"
        } else {
            "broken"
        };
        Lane { id, is_sidewalk, width_m: [width_m; 2], links: None, mark }
    };
    line(text, "<left>");
    (1..=lanes + 1).rev().for_each(|id| write_lane(text, &lane(id), length_m));
    let middle = if lanes > 1 { "solid" } else { "broken" };
    line(
        text,
        &format!(
            "</left><center><lane id=\"0\" type=\"none\" level=\"false\">{}</lane></center><right>",
            road_mark(middle)
        ),
    );
    (1..=lanes + 1).for_each(|id| write_lane(text, &lane(-id), length_m));
    line(text, "</right></laneSection></lanes>");
    line(text, "<objects>");
    write_crossings(text, index, street);
    text.push_str(objects);
    line(text, "</objects></road>");
}

/// One crossing at either end.
fn write_crossings(text: &mut String, index: usize, street: &Street) {
    let [from_mouth_m, along_m, onto_pavement_m] = CROSSING_M;
    let reach_m = street.profile.carriageway_m() + onto_pavement_m;
    for (end, s_m) in [from_mouth_m, street.line.length_m() - from_mouth_m].into_iter().enumerate() {
        write_crossing(text, 2 * index + end + 1, (&street.line, s_m), [along_m, reach_m], &Relief::default());
    }
}

/// The side of the street's lanes that a driver uses: towards (`inward`) or away from the junction at the arm.
fn lane_sign(arm: &Arm, inward: bool) -> i64 {
    if (arm.contact == RoadEnd::End) == inward { -1 } else { 1 }
}

fn contact_name(contact: RoadEnd) -> &'static str {
    match contact {
        RoadEnd::Start => "start",
        RoadEnd::End => "end",
    }
}

/// Lane ids that a turn's lane `-lane` comes from and leads to.
fn turn_links(turn: &JunctionWay, lane: i64, network: &Network) -> [i64; 2] {
    let is_sidewalk = lane > i64::from(turn.lanes);
    let of_arm = |arm: &Arm, skipped: u32, inward: bool| {
        let outermost = i64::from(network.streets[arm.street].profile.lanes) + 1;
        lane_sign(arm, inward) * if is_sidewalk { outermost } else { i64::from(skipped) + lane }
    };
    [of_arm(&turn.from, turn.skipped_lanes[0], true), of_arm(&turn.to, turn.skipped_lanes[1], false)]
}

fn write_turn(text: &mut String, index: usize, turn: &JunctionWay, network: &Network) {
    let length_m = turn.line.length_m();
    line(
        text,
        &format!(
            "<road name=\"turn {0}\" length=\"{1}\" id=\"{0}\" junction=\"{2}\">",
            FIRST_TURN + index,
            fixed(length_m, 9),
            FIRST_JUNCTION + turn.junction
        ),
    );
    line(
        text,
        &format!(
            "<link><predecessor elementType=\"road\" elementId=\"{}\" contactPoint=\"{}\"/><successor elementType=\"road\" elementId=\"{}\" contactPoint=\"{}\"/></link>",
            turn.from.street + 1,
            contact_name(turn.from.contact),
            turn.to.street + 1,
            contact_name(turn.to.contact)
        ),
    );
    line(text, "<type s=\"0\" type=\"town\"><speed max=\"30\" unit=\"km/h\"/></type>");
    write_plan_view(text, &turn.line, &Relief::default());
    line(
        text,
        &format!(
            "<lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\" level=\"false\">{}</lane></center><right>",
            road_mark("none")
        ),
    );
    for lane in 1..=i64::from(turn.lanes) {
        let links = Some(turn_links(turn, lane, network));
        write_lane(
            text,
            &Lane { id: -lane, is_sidewalk: false, width_m: [LANE_WIDTH_M; 2], links, mark: "none" },
            length_m,
        );
    }
    if let Some(width_m) = turn.sidewalk_m {
        let lane = i64::from(turn.lanes) + 1;
        let links = Some(turn_links(turn, lane, network));
        write_lane(text, &Lane { id: -lane, is_sidewalk: true, width_m, links, mark: "none" }, length_m);
    }
    line(text, "</right></laneSection></lanes></road>");
}

fn write_junction(text: &mut String, junction: usize, turns: &[JunctionWay], network: &Network) {
    let own: Vec<(usize, &JunctionWay)> =
        turns.iter().enumerate().filter(|(_, turn)| turn.junction == junction).collect();
    if own.is_empty() {
        return;
    }
    line(text, &format!("<junction id=\"{0}\" name=\"junction {0}\">", FIRST_JUNCTION + junction));
    for (connection, (index, turn)) in own.into_iter().enumerate() {
        let lanes = i64::from(turn.lanes) + i64::from(turn.sidewalk_m.is_some());
        let links: String = (1..=lanes)
            .map(|lane| format!("<laneLink from=\"{}\" to=\"{}\"/>", turn_links(turn, lane, network)[0], -lane))
            .collect();
        line(
            text,
            &format!(
                "<connection id=\"{connection}\" incomingRoad=\"{}\" connectingRoad=\"{}\" contactPoint=\"start\">{links}</connection>",
                turn.from.street + 1,
                FIRST_TURN + index
            ),
        );
    }
    line(text, "</junction>");
}

/// Every thing as an `<object>` of the straight street beside which it lies closest.
fn objects_by_street(network: &Network, things: &[GeneratedThing]) -> Vec<String> {
    let mut texts = vec![String::new(); network.streets.len()];
    let first_id = 2 * network.streets.len() + 1;
    for (index, thing) in things.iter().enumerate() {
        if let Some((street, foot)) = foot_on_street(network, thing.footprint.center()) {
            write_object(&mut texts[street], first_id + index, thing, &foot);
        }
    }
    texts
}

fn foot_on_street(network: &Network, point: DVec2) -> Option<(usize, Foot)> {
    let mut best: Option<(f64, usize, Foot)> = None;
    for (index, street) in network.streets.iter().enumerate().filter(|(_, street)| street.line.is_straight()) {
        let start = street.line.pose_at(0.0);
        let from_start = point - start.at;
        let (along_m, t_m) = (from_start.dot(start.ahead()), from_start.dot(start.left()));
        let s_m = along_m.clamp(0.0, street.line.length_m());
        let beyond_m = along_m - s_m;
        let badness = 100.0 * beyond_m.abs() + t_m.abs();
        if best.as_ref().is_none_or(|(least, ..)| badness < *least) {
            let origin = start.moved(s_m, t_m).at;
            best = Some((
                badness,
                index,
                Foot { s_m, t_m, beyond_m, origin, heading_rad: start.heading_rad, relief: Relief::default() },
            ));
        }
    }
    best.map(|(_, index, foot)| (index, foot))
}
