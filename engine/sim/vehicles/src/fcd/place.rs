//! [`Place`]: from the coordinates of a SUMO file to the world frame of a town.

use super::FcdError;
use cosfly_diagnose::plausible;
use cosfly_domain::Town;
use cosfly_frames::{DVec2, DVec3};
use cosfly_geodata::reference::GeoReference;
use cosfly_town::GroundIndex;

/// `<location>` of a SUMO net.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NetLocation {
    /// `netOffset`: what was added to the projected coordinates, metres.
    pub offset_m: DVec2,
    /// `projParameter`, where there is one.
    pub projection: Option<String>,
}

impl NetLocation {
    /// The location of a net, of a file that begins with `head`; 64 KiB are enough.
    ///
    /// # Errors
    /// No `<location>`, or one without a readable `netOffset`.
    pub fn of_net(head: &[u8]) -> Result<Self, FcdError> {
        let text = String::from_utf8_lossy(head);
        let refusal =
            |message: &str| FcdError::new(message).hint("give the `.net.xml` that the traffic was simulated on");
        let mut found = text.match_indices("<location");
        let (start, _) = found.next().ok_or_else(|| refusal("the net has no `<location>`"))?;
        let line_of = |at: usize| text[..at].matches('\n').count() as u64 + 1;
        let line = line_of(start);
        if let Some((second, _)) = found.next() {
            return Err(refusal(&format!("the net has a second `<location>`, beside the one in line {line}"))
                .at(line_of(second)));
        }
        let element = text[start..].split_once('>').map_or(&text[start..], |(element, _)| element);
        let attribute = |name: &str| {
            let (_, rest) = element.split_once(&format!(" {name}="))?;
            let quote = rest.chars().next().filter(|sign| ['"', '\''].contains(sign))?;
            rest[1..].split_once(quote).map(|(value, _)| value)
        };
        let offset = attribute("netOffset").and_then(|value| {
            let (x, y) = value.split_once(',')?;
            let offset: [f64; 2] = [x.trim().parse().ok()?, y.trim().parse().ok()?];
            offset.iter().all(|number| plausible(*number).is_ok()).then(|| DVec2::from_array(offset))
        });
        let offset_m =
            offset.ok_or_else(|| refusal("`netOffset` of the net is not two numbers within 1e9").at(line))?;
        // `!` is no projection.
        let projection = attribute("projParameter").filter(|text| !matches!(text.trim(), "" | "!")).map(str::to_owned);
        Ok(Self { offset_m, projection })
    }
}

/// From the coordinates of a SUMO file to the world frame of a town, on the town's ground.
pub struct Place {
    offset_m: DVec2,
    between: Between,
    town_offset_m: DVec3,
    ground: GroundIndex,
    low: DVec2,
    high: DVec2,
}

/// From the net's projection to that of the town's map.
enum Between {
    Nothing,
    /// The file has degrees (`--fcd-output.geo`).
    Degrees(GeoReference),
    Projections(GeoReference, GeoReference),
}

/// Bodies this far outside of a town are none of it, metres.
const MARGIN_M: f64 = 500.0;

impl Place {
    /// The place of a file in a town. `net` is the location of its net, `is_geo` says that positions are degrees.
    ///
    /// # Errors
    /// Projections that are needed and not known.
    pub fn new(town: &Town, net: &NetLocation, is_geo: bool) -> Result<Self, FcdError> {
        let parsed = |text: Option<&String>| text.and_then(|text| GeoReference::parse(text));
        let own = town.origin.geo_reference.as_ref();
        let unknown = |what: &str| {
            FcdError::new(format!("the place of the traffic in the town is not known: {what}"))
                .hint("cosfly compares the projections in the table of the page \"Real towns\" (PROJ texts, EPSG codes): UTM, transverse Mercator, national grids")
        };
        let between = match (is_geo, &net.projection) {
            (true, _) => {
                let own = parsed(own).ok_or_else(|| match own {
                    None => unknown("the town's map has no projection for degrees"),
                    Some(text) => {
                        unknown(&format!("projection of the town's map: {}", GeoReference::why_unknown(text)))
                    }
                })?;
                Between::Degrees(own)
            }
            // Nets of maps without a projection, and of the same one.
            (false, None) => Between::Nothing,
            (false, Some(text)) if own.is_some_and(|own| own.trim() == text.trim()) => Between::Nothing,
            // A word of SUMO for a projection of its own; a map of the same net has none.
            (false, Some(text)) if own.is_none() && GeoReference::parse(text).is_none() && !text.contains("proj=") => {
                Between::Nothing
            }
            (false, Some(text)) => {
                let net = GeoReference::parse(text).ok_or_else(|| {
                    unknown(&format!("projection `{text}` of the net: {}", GeoReference::why_unknown(text)))
                })?;
                let own = parsed(own).ok_or_else(|| match own {
                    None => unknown("the town's map has no projection, but the net has one"),
                    Some(text) => {
                        unknown(&format!("projection of the town's map: {}", GeoReference::why_unknown(text)))
                    }
                })?;
                Between::Projections(net, own)
            }
        };
        Ok(Self {
            offset_m: if is_geo { DVec2::ZERO } else { net.offset_m },
            between,
            town_offset_m: town.origin.offset_m,
            ground: GroundIndex::new(town),
            low: town.min_in_world.truncate() - MARGIN_M,
            high: town.max_in_world.truncate() + MARGIN_M,
        })
    }

    /// A point of the file in the world, in plan; `None` where the projections know none.
    pub fn plan(&self, point: DVec2) -> Option<DVec2> {
        let in_map = match &self.between {
            Between::Nothing => point - self.offset_m,
            Between::Degrees(own) => own.project(point.to_array()),
            Between::Projections(net, own) => own.project(net.unproject(point - self.offset_m)?),
        };
        Some(DVec2::new(in_map.x, -in_map.y) - self.town_offset_m.truncate()).filter(|point| point.is_finite())
    }

    /// A point `length` ahead of another one by an angle clockwise from north, in the file's own units.
    pub(super) fn is_geo(&self) -> bool {
        matches!(self.between, Between::Degrees(_))
    }

    /// Whether a point of the world is in the town or not far away.
    pub fn holds(&self, point: DVec2) -> bool {
        point.cmpge(self.low).all() && point.cmple(self.high).all()
    }

    /// The point on the ground.
    pub fn on_ground(&self, point: DVec2) -> DVec3 {
        point.extend(self.ground.ground_height_m(point.x, point.y).unwrap_or(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_location_of_a_net_is_read() {
        let head = b"<?xml version=\"1.0\"?>\n<net version=\"1.20\">\n    <location netOffset=\"12.50,-3.00\" convBoundary=\"0,0,1,1\" origBoundary=\"0,0,1,1\" projParameter=\"!\"/>\n";
        let location = NetLocation::of_net(head).unwrap();
        assert_eq!(location, NetLocation { offset_m: DVec2::new(12.5, -3.0), projection: None });
        assert!(NetLocation::of_net(b"<net>").unwrap_err().to_string().contains("no `<location>`"));
        let broken = NetLocation::of_net(b"<net>\n<location netOffset=\"nan,1\"/>").unwrap_err();
        assert!(broken.to_string().contains("line 2"), "{broken}");
    }
}
