//! The unit of depth images, and their assignment to frames.

use super::median::median;
use super::motion::frames;
use super::surface;
use cosfly_episodes::episode::OFFSETS;
use cosfly_episodes::{ExaminedEpisode, Flag};

/// Range of the depth of a body's surface over that of its middle.
const RATIOS: (f64, f64) = (0.8, 1.25);
/// Smallest number of frames with a target in full view for a verdict.
const ENOUGH: usize = 4;
/// Units per metre, and their names.
const UNITS: [(f64, &str); 4] =
    [(1000.0, "millimetres"), (100.0, "centimetres"), (0.001, "kilometres"), (1.0 / 0.3048, "feet")];
/// Largest spread of the depths of a body around their middle, metres.
const SPREAD_M: f64 = 0.4;

/// Compares depth images with distances to the target.
pub fn check(episode: &ExaminedEpisode) -> Vec<Flag> {
    // A body that is hidden in parts shows the depth of what hides it.
    let free = |frame: usize| episode.moments.get(frame).and_then(|it| it.visible).is_none_or(|share| share > 0.95);
    let looks: Vec<_> = episode.looks.iter().filter(|look| free(look.frame)).collect();
    let pairs: Vec<(f64, f64)> = looks
        .iter()
        .filter_map(|look| Some((look.depth_m.first().copied().flatten()?, episode.depth_of_target(look.frame)?)))
        .collect();
    if pairs.len() < ENOUGH {
        return vec![];
    }
    let Some(ratio) = median(pairs.iter().map(|(found, expected)| found / expected)) else { return vec![] };
    let flag = |name, message: String| vec![Flag::damage(name, &episode.id, message)];
    let is_off = !(RATIOS.0..RATIOS.1).contains(&ratio);
    let has_unit = |per_metre: f64| (RATIOS.0..RATIOS.1).contains(&(ratio / per_metre));
    if let Some((_, unit)) = UNITS.into_iter().find(|(per_metre, _)| is_off && has_unit(*per_metre)) {
        return flag("depth-unit", format!("depth is in {unit}: {ratio:.4} times the distance in metres"));
    }
    if episode.is_mount_unknown {
        // Distances and depths along an axis that is not known differ by what the target is off the axis.
        return vec![];
    }
    let spread = |place: usize| {
        let gaps: Vec<f64> = looks
            .iter()
            .filter_map(|look| {
                let frame = look.frame.checked_add_signed(OFFSETS[place] as isize).filter(|at| free(*at))?;
                Some(look.depth_m.get(place).copied().flatten()? - episode.depth_of_target(frame)?)
            })
            .collect();
        let middle = median(gaps.iter().copied())?;
        (gaps.len() >= ENOUGH).then(|| median(gaps.iter().map(|gap| (gap - middle).abs())))?
    };
    let Some(own) = spread(0) else { return vec![] };
    let others = (1..OFFSETS.len()).filter_map(|place| Some((OFFSETS[place], spread(place)?)));
    match others.min_by(|a, b| a.1.total_cmp(&b.1)) {
        // A body of a few pixels beside other bodies shows their depth; walls know better.
        Some((shift, best))
            if best * 4.0 < own && own > SPREAD_M && best < SPREAD_M && !surface::are_in_place(episode) =>
        {
            flag(
                "image-shift",
                format!(
                    "images are those of {}: depths at the target miss by {own:.2} m, by {best:.2} m with that frame's pose",
                    frames(shift)
                ),
            )
        }
        _ if is_off => flag("depth-mismatch", format!("depth at the target is {ratio:.3} times its distance")),
        _ => vec![],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_episodes::{ExaminedLook, ExaminedMoment};
    use cosfly_frames::{DVec3, Pose};

    #[test]
    fn depth_of_pictures_all_around_is_compared_along_rays() {
        // 20 m ahead and 20 m beside: 20 m along the axis, 28.3 m along the ray.
        let pose = Pose::looking_at(DVec3::ZERO, DVec3::X);
        let moment = ExaminedMoment {
            time_s: 0.0,
            drone: pose,
            camera: pose,
            next_in_world: None,
            turn_deg: None,
            target_in_world: Some(DVec3::new(20.0, 20.0, 0.0)),
            heading_and_speed: None,
            in_image: None,
            visible_box: None,
            visible: Some(1.0),
            clearance_m: None,
        };
        let named = |depth_m: f64, depth_is_along_rays: bool| {
            let look =
                |frame| ExaminedLook { frame, depth_m: vec![Some(depth_m); OFFSETS.len()], ..Default::default() };
            let (moments, looks) = (vec![moment.clone(); 5], (0..5).map(look).collect());
            let episode = ExaminedEpisode { depth_is_along_rays, moments, looks, ..Default::default() };
            check(&episode).iter().map(|flag| flag.name).collect::<Vec<_>>()
        };
        assert_eq!((named(28.3, true), named(20.0, false)), (vec![], vec![]));
        let unknown = |metres: f64| {
            let look = |frame| ExaminedLook { frame, depth_m: vec![Some(metres); OFFSETS.len()], ..Default::default() };
            let (moments, looks) = (vec![moment.clone(); 5], (0..5).map(look).collect());
            let episode = ExaminedEpisode { is_mount_unknown: true, moments, looks, ..Default::default() };
            check(&episode).iter().map(|flag| flag.name).collect::<Vec<_>>()
        };
        assert_eq!((unknown(28.3), unknown(20.0), unknown(28_300.0)), (vec![], vec![], vec!["depth-unit"]));
        assert_eq!((named(20.0, true), named(28.3, false)), (vec!["depth-mismatch"], vec!["depth-mismatch"]));
    }
}
