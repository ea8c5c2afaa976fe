//! Days that pictures of scans can show: the light of a scan is in its colours.

use crate::presets::{PRESETS, preset};
use crate::weather::WeatherRanges;
use cosfly_domain::Season;

/// Numbers of a weather that change the air before a scan.
pub const IN_THE_AIR: [&str; 3] = ["fog_density", "fog_distance", "precipitation"];

/// The key of a stage that pictures of the scan under `scan` cannot follow, what is wrong with it, and what is allowed. A scan that
/// `has_nights` is lit by the weather.
pub fn refusal(
    (scan, has_nights): (&str, bool),
    weathers: &[String],
    ranges: &WeatherRanges,
    season: Option<Season>,
) -> Option<(String, String, String)> {
    if season.is_some() {
        let hint = "leave `season` out: trees and lawns are those of the scan".to_owned();
        return Some(("season".to_owned(), format!("the season of `{scan}` cannot be changed"), hint));
    }
    let is_shown = |name: &str| is_dry(name, has_nights);
    if let Some((index, name)) = weathers.iter().enumerate().find(|(_, name)| !is_shown(name)) {
        let days: Vec<&str> = PRESETS.into_iter().filter(|name| is_shown(name)).collect();
        let message = if has_nights {
            format!("`{name}` is wet or dusty, and `{scan}` is as dry as it was scanned")
        } else {
            format!("`{name}` is wet, dusty or dark, and `{scan}` is as dry and bright as it was scanned")
        };
        let hint = format!(
            "with `{scan}`, the weathers are {}: they light people and vehicles; rain and haze in the air are \
             `weather.precipitation` and `weather.fog_density`",
            days.join(", ")
        );
        return Some((format!("weathers[{index}]"), message, hint));
    }
    let changed = ranges.all().into_iter().find_map(|(name, range, _)| {
        let [low, _] = range?;
        let is_of_light = matches!(name, "cloudiness" | "wind_intensity" | "sun_azimuth_angle");
        (!(is_of_light || IN_THE_AIR.contains(&name) || name == "sun_altitude_angle" && (low > 0.0 || has_nights)))
            .then_some(name)
    });
    changed.map(|name| {
        let message = format!("`{name}` changes the ground or the day, and `{scan}` stays as it was scanned");
        let above = if has_nights { "" } else { " above 0" };
        let hint = format!(
            "with `{scan}`, give `cloudiness`, `sun_azimuth_angle`, or `sun_altitude_angle`{above}, which light people and \
             vehicles, or what is in the air: {}",
            IN_THE_AIR.map(|name| format!("`{name}`")).join(", ")
        );
        (format!("weather.{name}"), message, hint)
    })
}

/// Whether a preset is without water or dust, and a day or one of `nights`, too.
fn is_dry(name: &str, nights: bool) -> bool {
    preset(name).is_none_or(|weather| {
        let water = weather.precipitation + weather.precipitation_deposits + weather.wetness;
        (nights || weather.sun_altitude_angle > 0.0) && water + weather.dust_storm == 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_scan_cannot_show_is_refused_by_name() {
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let plain = WeatherRanges::default();
        assert_eq!(refusal(("mesh", false), &names(&["ClearNoon", "CloudySunset"]), &plain, None), None);
        let path = |weathers: &[&str], ranges: &WeatherRanges, season| {
            refusal(("splats", false), &names(weathers), ranges, season).expect("refused").0
        };
        assert_eq!(path(&["ClearNoon", "ClearNight"], &plain, None), "weathers[1]");
        assert_eq!(path(&["WetNoon"], &plain, None), "weathers[0]");
        assert_eq!(path(&["ClearNoon"], &plain, Some(Season::Winter)), "season");
        let fog = WeatherRanges { fog_density: Some([0.0, 30.0]), ..plain.clone() };
        assert_eq!(refusal(("mesh", false), &names(&["ClearNoon"]), &fog, None), None, "haze is in the air");
        let rain = WeatherRanges { precipitation: Some([60.0, 60.0]), ..plain.clone() };
        assert_eq!(refusal(("splats", false), &names(&["CloudyNoon"]), &rain, None), None, "rain is in the air");
        let wet = WeatherRanges { wetness: Some([0.0, 30.0]), ..rain };
        assert_eq!(path(&["ClearNoon"], &wet, None), "weather.wetness");
        let puddles = WeatherRanges { precipitation_deposits: Some([1.0, 1.0]), ..plain.clone() };
        assert_eq!(path(&["ClearNoon"], &puddles, None), "weather.precipitation_deposits");
        let night = WeatherRanges { sun_altitude_angle: Some([-5.0, 30.0]), ..plain.clone() };
        assert_eq!(path(&["ClearNoon"], &night, None), "weather.sun_altitude_angle");
        assert_eq!(refusal(("mesh", true), &names(&["ClearNight"]), &night, None), None, "lit by the weather");
        assert!(refusal(("mesh", true), &names(&["WetNight"]), &plain, None).is_some_and(|it| !it.1.contains("dark")));
        let sun = WeatherRanges { sun_azimuth_angle: Some([90.0, 90.0]), ..plain };
        assert_eq!(refusal(("mesh", false), &names(&["ClearNoon"]), &sun, None), None);
    }
}
