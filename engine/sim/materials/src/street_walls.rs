//! Which walls of buildings stand at a pavement: shops are there alone, not in gardens.

use crate::ground_kinds::GroundKinds;
use crate::parts::{BOX_FACES, SceneBox};
use crate::roof_steps::ends_m;
use cosfly_domain::ObstacleKind;

/// Distances from a wall at which paved ground is looked for, metres.
const AWAY_M: [f64; 6] = [0.3, 0.8, 1.3, 1.8, 2.3, 2.8];
/// Places along a wall that are looked at, as shares of half its width from its middle, and how many of them are paved.
const ALONG: [f64; 5] = [-0.9, -0.45, 0.0, 0.45, 0.9];
const PAVED_PLACES: usize = 4;
/// A part of a building whose foot is higher than this above the foot of the whole does not stand in the street, metres.
pub(crate) const IN_STREET_M: f64 = 2.0;

/// Tells the walls of all buildings; their wholes are known.
pub fn tell_street_walls(boxes: &mut [SceneBox], ground: &GroundKinds) {
    for b in boxes.iter_mut().filter(|b| b.kind == ObstacleKind::Building) {
        let [middle, half_whole] = b.whole;
        if ends_m(b)[0] <= f64::from(middle.z - half_whole.z) + IN_STREET_M {
            b.is_at_street = [0, 1, 2, 3].map(|face| is_at_street(b, face, ground));
        }
    }
}

fn is_at_street(b: &SceneBox, face: usize, ground: &GroundKinds) -> bool {
    let (axis, sign, _) = BOX_FACES[face];
    let [out, along] = [axis, 1 - axis].map(|axis| b.axes_in_world[axis].truncate());
    let half = b.half_extents_m.as_dvec3();
    let at = |share: f64, away_m: f64| {
        b.center_in_world.truncate() + sign * (half[axis] + away_m) * out + share * half[1 - axis] * along
    };
    let is_paved = |share: &f64| AWAY_M.iter().any(|away_m| ground.is_paved(at(*share, *away_m)));
    ALONG.iter().filter(|share| is_paved(share)).count() >= PAVED_PLACES
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::{boxes_of, join_wholes};
    use cosfly_domain::{Obstacle, OrientedBox, SemanticLabel, SurfaceMesh, Town};
    use cosfly_frames::{DVec2, DVec3};

    #[test]
    fn walls_at_a_pavement_are_told_from_those_in_a_garden() {
        let pavement = SurfaceMesh {
            label: SemanticLabel::SideWalks,
            vertices_in_world: [[-50.0, -8.0], [50.0, -8.0], [50.0, -6.0], [-50.0, -6.0]]
                .map(|[x, y]| DVec3::new(x, y, 0.1))
                .to_vec(),
            along_across_m: vec![DVec2::ZERO; 4],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            synthetic: false,
        };
        let house = |y: f64, z: f64| Obstacle {
            shape: OrientedBox::from_corners(DVec3::new(-5.0, y, z), DVec3::new(5.0, y + 8.0, z + 6.0)),
            kind: ObstacleKind::Building,
            object_id: y as u32,
            synthetic: false,
        };
        let told = |obstacles: Vec<Obstacle>| {
            let town = Town { obstacles, surfaces: vec![pavement.clone()], ..Town::default() };
            let mut boxes = boxes_of(&town, 1);
            join_wholes(&mut boxes);
            tell_street_walls(&mut boxes, &GroundKinds::of(&town));
            boxes.iter().map(|b| b.is_at_street).collect::<Vec<_>>()
        };
        let front_alone = [false, false, true, false];
        assert_eq!(told(vec![house(-5.0, 0.0), house(-5.0, 6.0)]), [front_alone, [false; 4]]);
        assert_eq!(told(vec![house(-3.5, 0.0)]), [front_alone]);
        assert_eq!(told(vec![house(0.0, 0.0)]), [[false; 4]]);
    }
}
