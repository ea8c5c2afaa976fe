//! Clouds of coloured points as splats: each point is round, as large as the distance to its neighbours asks.

use super::check_count;
use crate::cloud::SplatCloud;
use crate::error::SplatError;
use crate::splat::Splat;
use cosfly_frames::DVec3;
use cosfly_scans::coloured;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Neighbour whose distance counts: surfaces of points in rows close.
const NEIGHBOUR: usize = 3;
/// Standard deviation in distances of that neighbour.
const SPREAD: f64 = 0.5;
/// Least and largest distance that counts, medians of all.
const USUAL: [f64; 2] = [0.25, 4.0];
/// Points in a cell in which neighbours are looked for, about.
const POINTS_OF_CELL: f64 = 4.0;
/// One point of so many is left out at each end of an axis where the size of a cloud is measured.
const ENDS: usize = 20;
/// Most points of a cell that are compared.
const MOST_COMPARED: usize = 64;
/// Opacity of a point.
const OPACITY: f32 = 0.95;

pub(super) fn read(bytes: &[u8]) -> Result<SplatCloud, SplatError> {
    let points = coloured::read(bytes);
    let mut points = points.map_err(|error| SplatError { message: error.message, hints: error.hints })?;
    check_count(points.len())?;
    points.retain(|point| point.position.abs().cmple(DVec3::splat(1e8)).all());
    let Some(first) = points.first() else {
        return Err(SplatError::cut_off("the cloud has no point with finite coordinates"));
    };
    let origin = first.position.round();
    let positions: Vec<DVec3> = points.iter().map(|point| point.position - origin).collect();
    let spreads = spreads(&positions);
    let mut cloud = SplatCloud::new(0).with_origin(origin.to_array());
    for ((point, position), spread) in points.iter().zip(&positions).zip(spreads) {
        let srgb = point.colour.map(|value| f32::from(value) / 255.0);
        let middle = position.as_vec3().to_array();
        cloud.push(&Splat::plain(middle, [spread; 3], [1.0, 0.0, 0.0, 0.0], OPACITY, srgb));
    }
    Ok(cloud)
}

/// The spread of each point.
fn spreads(positions: &[DVec3]) -> Vec<f32> {
    let cell = side_of_cell(positions);
    let cell_of = |position: &DVec3| (*position / cell).floor().to_array().map(|at| at as i64);
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    for (number, position) in (0..).zip(positions) {
        cells.entry(cell_of(position)).or_default().push(number);
    }
    let distance = |(number, position): (usize, &DVec3)| {
        let [x, y, z] = cell_of(position);
        let mut nearest = [f64::INFINITY; NEIGHBOUR];
        let around =
            (-1..=1).flat_map(|dx| (-1..=1).flat_map(move |dy| (-1..=1).map(move |dz| [x + dx, y + dy, z + dz])));
        for own in around.filter_map(|cell| cells.get(&cell)) {
            for other in own.iter().take(MOST_COMPARED).filter(|other| **other as usize != number) {
                let away = positions[*other as usize].distance(*position);
                let place = nearest.partition_point(|known| *known <= away);
                if place < NEIGHBOUR {
                    nearest[place..].rotate_right(1);
                    nearest[place] = away;
                }
            }
        }
        nearest[NEIGHBOUR - 1]
    };
    let distances: Vec<f64> = positions.par_iter().enumerate().map(distance).collect();
    let mut sorted: Vec<f64> = distances.iter().copied().filter(|away| away.is_finite() && *away > 0.0).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(cell);
    let [least, most] = USUAL.map(|share| share * median);
    distances.into_iter().map(|away| (SPREAD * away.clamp(least, most)) as f32).collect()
}

/// Side of cells that hold some points each: points lie on surfaces, so that their number grows with the square of it. Few points
/// far from all others do not change it.
fn side_of_cell(positions: &[DVec3]) -> f64 {
    let axes = [0, 1, 2].map(|axis| {
        let mut sorted: Vec<f64> = positions.iter().map(|position| position[axis]).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted
    });
    let last = positions.len() - 1;
    let area = |left_out: usize| {
        // As long as all points would be if they lay as those of the middle do.
        let longer = last as f64 / (last - 2 * left_out).max(1) as f64;
        let [x, y, z] = axes.each_ref().map(|sorted| longer * (sorted[last - left_out] - sorted[left_out]));
        (x * y).max(y * z).max(x * z)
    };
    let area = [last / ENDS, 0].map(area).into_iter().find(|area| *area > 0.0).unwrap_or(0.0);
    (POINTS_OF_CELL * area / positions.len() as f64).sqrt().max(1e-3)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A level sheet of points far from the origin, `gap` apart.
    fn sheet(gap: f64) -> Vec<u8> {
        let mut text =
            "ply\nformat ascii 1.0\nelement vertex 400\nproperty double x\nproperty double y\nproperty double z\n\
                        property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
                .to_owned();
        for number in 0..400 {
            let (x, y) = (gap * f64::from(number % 20), gap * f64::from(number / 20));
            text += &format!("{} {} 12 200 100 50\n", 500_000.0 + x, 4_000_000.0 + y);
        }
        text.into_bytes()
    }

    #[test]
    fn points_are_as_large_as_their_distances_ask_and_keep_their_places() {
        for gap in [0.1, 2.0] {
            let cloud = read(&sheet(gap)).expect("a cloud");
            assert_eq!((cloud.len(), cloud.origin()), (400, [500_000.0, 4_000_000.0, 12.0]));
            let spread = f64::from(cloud.blocks()[2].covariance[0][0]).sqrt();
            assert!((spread - SPREAD * gap).abs() < 0.3 * gap, "{spread} of {gap}");
        }
    }

    #[test]
    fn a_point_far_from_all_others_changes_no_other() {
        let mut text = String::from_utf8(sheet(0.1)).expect("text").replace("vertex 400", "vertex 401");
        text += "530000 4030000 900 200 100 50\n";
        let cloud = read(text.as_bytes()).expect("a cloud");
        let spread = f64::from(cloud.blocks()[2].covariance[0][0]).sqrt();
        assert!((spread - SPREAD * 0.1).abs() < 0.03, "{spread}");
    }

    #[test]
    fn points_without_colours_are_refused() {
        let plain = String::from_utf8(sheet(1.0)).expect("text").replace("uchar green", "uchar grey");
        assert!(read(plain.as_bytes()).expect_err("refused").message.contains("`green`"));
    }
}
