//! OpenDRIVE files of absurd counts, lengths and nesting end in an error, or in a town, in bounded time and memory.

use cosfly_domain::Town;
use cosfly_frames::Seed;
use cosfly_maps::{MapConfig, read_town};
use cosfly_town::MapError;
use std::time::{Duration, Instant};

/// A road of every curve, with every kind of profile, object and signal.
const STREET: &str = include_str!("../src/formats/opendrive/every_feature.xodr");

/// Far beyond what any input takes: a guard against hanging, not a measurement.
const HANGS_AFTER: Duration = Duration::from_secs(120);

fn read(text: &str) -> Result<Town, MapError> {
    let start = Instant::now();
    let read = read_town(text.as_bytes(), &MapConfig::default(), Seed::of_item(1, "town", "town"));
    assert!(start.elapsed() < HANGS_AFTER, "{:?}", start.elapsed());
    println!(
        "{:.2} s, {:?}",
        start.elapsed().as_secs_f64(),
        read.as_ref().map_or_else(ToString::to_string, |_| "town".into())
    );
    let (town, _) = read?;
    town.assert_well_formed().expect("a town that was read is well formed");
    Ok(town)
}

/// The street with one piece of its text replaced.
fn with(from: &str, to: &str) -> String {
    assert!(STREET.contains(from), "`{from}` is in the example");
    STREET.replacen(from, to, 1)
}

fn check_refused(text: &str, expected: &str) {
    let error = read(text).expect_err(expected);
    assert!(error.to_string().contains(expected), "`{error}` says `{expected}`");
}

#[test]
fn deep_nesting_and_many_attributes_are_refused() {
    for depth in [1_000, 200_000] {
        let nested = format!("{}{}<lateralProfile>", "<a>".repeat(depth), "</a>".repeat(depth));
        check_refused(&with("<lateralProfile>", &nested), "nested more than 100 deep");
    }
    let namespaces: String = (0..50_000).map(|i| format!("<a xmlns:a{i}=\"{i}\">")).collect();
    check_refused(&with("<lateralProfile>", &format!("{namespaces}<lateralProfile>")), "nested more than 100 deep");
    let attributes: String = (0..200_000).map(|i| format!(" a{i}=\"1\"")).collect();
    check_refused(&with("<lateralProfile>", &format!("<a{attributes}/><lateralProfile>")), "more than 1000 attributes");
}

#[test]
fn absurd_numbers_end_in_an_error_or_a_town() {
    for (from, to) in [
        ("distance=\"8\"", "distance=\"1e-9\""),
        ("length=\"40\"><line/>", "length=\"999999\"><arc curvature=\"999\"/>"),
        ("length=\"40\"><line/>", "length=\"999999\"><spiral curvStart=\"0\" curvEnd=\"999\"/>"),
        ("curvStart=\"0.02\"", "curvStart=\"-1000\""),
        (
            "<width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>",
            "<width sOffset=\"0\" a=\"3.5\" b=\"1e7\" c=\"-1e8\" d=\"1e8\"/>",
        ),
        ("space=\"4\"", "space=\"0\""),
        ("x=\"0\" y=\"0\"", "x=\"1e8\" y=\"-1e8\""),
        ("u=\"-6\"", "u=\"-99999\""),
    ] {
        print!("{to}: ");
        let _ = read(&with(from, to));
    }
}

#[test]
fn turns_that_no_road_has_are_refused() {
    check_refused(&with("curvature=\"0.02\"", "curvature=\"999\""), "the arc turns by 19980 rad");
    check_refused(&with("curvEnd=\"-0.01\"", "curvEnd=\"-900\""), "the spiral turns by 27000 rad");
}

/// One road with a very large number of one element.
fn road_of(length_m: f64, lanes: &str, objects: &str) -> String {
    format!(
        "<OpenDRIVE><road id='1' length='{length_m}'><planView><geometry s='0' x='0' y='0' hdg='0' \
         length='{length_m}'><line/></geometry></planView><lanes>{lanes}</lanes><objects>{objects}</objects></road>\
         </OpenDRIVE>"
    )
}

fn lanes_of_a_side(count: usize, kind: &str) -> String {
    let lane = |id| format!("<lane id='-{id}' type='{kind}'><width sOffset='0' a='0.5'/></lane>");
    (1..=count).map(lane).collect()
}

#[test]
fn sections_that_copy_the_lanes_of_others_are_bounded() {
    let many = format!("<laneSection s='0'><right>{}</right></laneSection>", lanes_of_a_side(1000, "sidewalk"));
    let copies = "<laneSection s='1' singleSide='true'><left/></laneSection>".repeat(20_000);
    check_refused(&road_of(9.0, &(many + &copies), ""), "more than 1000000 lanes over all lane sections");
}

#[test]
fn many_lanes_over_a_long_road_are_bounded() {
    let many = format!("<laneSection s='0'><right>{}</right></laneSection>", lanes_of_a_side(1000, "sidewalk"));
    check_refused(&road_of(999_999.0, &many, ""), "more than 8000000 lane edges");
}

#[test]
fn many_sections_times_many_records_are_bounded() {
    let sections = "<laneSection s='1'/>".repeat(40_000);
    let offsets = "<laneOffset s='2' a='0'/>".repeat(40_000);
    check_refused(&road_of(9.0, &(offsets + &sections), ""), "lane edges");
}

#[test]
fn repeats_of_nothing_are_bounded() {
    let lanes = format!("<laneSection s='0'><right>{}</right></laneSection>", lanes_of_a_side(4, "sidewalk"));
    let repeat = "<repeat s='0' length='99999' distance='1e-3' tStart='9' tEnd='9'/>";
    let objects = format!("<object type='building' s='0' t='9' id='1'>{repeat}</object>").repeat(2_000);
    check_refused(&road_of(99_999.0, &lanes, &objects), "more than 500000 solid boxes");
}

#[test]
fn ground_of_absurd_area_takes_bounded_memory() {
    let lane = |id: i32| format!("<lane id='-{id}' type='sidewalk'><width sOffset='0' a='999'/></lane>");
    let lanes: String = (1..=400).map(lane).collect();
    let _ = read(&road_of(4_000.0, &format!("<laneSection s='0'><right>{lanes}</right></laneSection>"), ""));
}
