//! Which kernels pixels of a material go through, in both looks.

use super::cloth::{Cloths, cloth};
use super::coach::coach;
use super::contact::contact;
use super::geometry::{open, place, points};
use super::headlights::shine;
use super::lighting::{Kinds, Mirror};
use super::material::Material;
use super::setting::{Seen, Setting};
use super::skin::painted;
use super::{lighting, simple};
use cosfly_domain::SemanticLabel;
use cosfly_materials::facade::{facade, lift, roofs, tiles};
use cosfly_materials::ground::ground;
use cosfly_materials::kerbs::{Kerbs, stones};
use cosfly_materials::lane_wear::worn;
use cosfly_materials::lanes::{Block, FOUR, LANES, PendingFours, Shared, StageRow, WIDE, set};
use cosfly_materials::leaves::{Crowns, even_leaves, leaves, part_woods, swell};
use cosfly_materials::paving::pave;
use cosfly_materials::thing_paint::things;
use cosfly_materials::vector::Vec3;

/// Sunlight on leaves is looked up this far towards the sun, metres.
const OFF_CROWN_M: f32 = 1.5;

/// Fours on the stage, with the people, crowns or colours that they show.
pub(super) struct Staged<'a> {
    pub stage: &'a PendingFours,
    pub cloths: &'a Cloths,
    pub crowns: &'a mut Crowns,
    pub kerbs: &'a Kerbs,
    /// Colours of even surfaces in the simple look.
    pub colours: &'a [StageRow; 3],
    /// What a lit mesh reflects at each pixel.
    pub albedo: &'a [[f32; 3]; LANES],
}

/// Puts what a lit mesh reflects into the blocks of the stage's pixels.
fn reflect(blocks: &mut [Block], albedo: &[[f32; 3]; LANES]) {
    let groups = blocks.as_chunks_mut::<FOUR>().0.iter_mut().zip(albedo.as_chunks::<{ FOUR * WIDE }>().0);
    for (four, albedo) in groups {
        for (at, [red, green, blue]) in albedo.iter().enumerate() {
            set(&mut four[at % FOUR].albedo, at / FOUR, Vec3::new(*red, *green, *blue));
        }
    }
}

/// Draws a group in the full look; `near` are the people who may darken it.
pub(super) fn run_kernels(
    setting: &Setting,
    seen: &Seen<'_>,
    material: &Material,
    Staged { stage, cloths, crowns, kerbs, albedo, .. }: Staged<'_>,
    (shared, blocks): (&mut [Shared], &mut [Block]),
    near: &[u32],
) {
    let (level, light, noise) = (setting.level, &setting.light, &seen.scene.noise);
    if let Material::Sky = material {
        let air = (light, setting.haze, &seen.scene.outskirts);
        lighting::sky(level, blocks, stage, &setting.view, air, &setting.tone, noise);
        return;
    }
    let grid = &seen.scene.grid;
    place(level, shared, stage, &setting.view, light);
    points(level, shared, blocks, stage, &setting.view);
    if let Material::Leaves = material {
        part_woods(level, crowns, shared, noise);
        swell(level, shared, crowns, setting.view.position, setting.view.pixel());
    }
    open(level, shared, grid.tables(), &grid.frame(), light.night > 0.0);
    let is_shaded = matches!(material, Material::Ground(_) | Material::Scan) && !near.is_empty();
    if is_shaded {
        blocks.iter_mut().for_each(|block| block.openness = [1.0; WIDE]);
        near.iter().for_each(|one| contact(level, shared, blocks, &seen.people.members[*one as usize].figure));
    }
    let is_bent = material.is_bent();
    if let Material::Tiles(_) = material {
        lift(level, blocks);
    }
    if material.faces_away(stage, light) {
        blocks.iter_mut().for_each(|block| block.sunlight = [0.0; WIDE]);
    } else {
        if let Material::Leaves = material {
            leaves(level, shared, blocks, crowns, setting.view.position, light.to_sun * OFF_CROWN_M, noise);
        }
        let in_map = !matches!(material, Material::Ground(_) | Material::Cloth | Material::Coach(_));
        setting.shadows.sunlight(level, blocks, [!is_bent, in_map], noise, near);
    }
    match material {
        // The sky and leaves are done; even surfaces are of the simple look.
        Material::Sky | Material::Leaves | Material::Even => {}
        Material::Ground(label) => {
            ground(
                level,
                shared,
                blocks,
                *label,
                (grid.tables(), &grid.frame()),
                cosfly_materials::season::row(seen.scene.season).lawn,
                noise,
            );
            if *label == SemanticLabel::Roads {
                worn(level, shared, blocks, &seen.scene.wear, noise);
            }
            if *label == SemanticLabel::SideWalks {
                pave(level, shared, blocks, kerbs, noise);
                stones(level, shared, blocks, kerbs, seen.scene.kerb_tone, noise);
            }
        }
        Material::Scan => reflect(blocks, albedo),
        Material::Facade(look, face) => facade(level, shared, blocks, look, face, light, noise),
        Material::Roof(roof) => roofs(level, shared, blocks, roof, light, noise),
        Material::Tiles(slope) => tiles(level, shared, blocks, slope, noise),
        Material::Thing(thing) => things(level, shared, blocks, thing, noise),
        Material::Cloth => cloth(level, shared, blocks, cloths, noise),
        Material::Coach(look) => coach(level, shared, blocks, look, noise),
        Material::Skin(look) => painted(shared, blocks, look, &seen.scene.props.textures),
    }
    lighting::arriving(level, shared, light, setting.haze);
    if is_bent {
        lighting::develop_bent(level, shared, blocks, light, &setting.tone);
        return;
    }
    let answers = material.answers();
    let is_wet = answers.wettable && light.wet > 0.0;
    if is_wet {
        lighting::wet(level, shared, blocks, light, noise);
    }
    let is_shiny = is_wet || answers.shiny;
    if is_shiny {
        let mirror = match material {
            _ if is_wet => Mirror::FILM,
            Material::Coach(_) => Mirror::COAT,
            _ => Mirror::PANE,
        };
        lighting::mirrored(level, shared, light, mirror, (grid.tables(), &grid.frame()), noise);
    }
    let mut glows = answers.glows && light.night > 0.0;
    if light.night > 0.0 {
        let walkers = near.iter().map(|one| &seen.people.members[*one as usize].figure);
        walkers.for_each(|walker| glows |= shine(level, shared, blocks, walker, light));
    }
    let kinds = Kinds { glows, shiny: is_shiny, shaded: is_shaded };
    lighting::develop(level, shared, blocks, light, &setting.tone, kinds);
}

/// Draws a group in the simple look.
pub(super) fn run_simple_kernels(
    setting: &Setting,
    material: &Material,
    Staged { stage, crowns, colours, albedo, .. }: Staged<'_>,
    (shared, blocks): (&mut [Shared], &mut [Block]),
) {
    let (level, light, tone) = (setting.level, &setting.light, &setting.tone);
    if let Material::Sky = material {
        simple::sky(level, blocks, stage, &setting.view, light, tone);
        return;
    }
    place(level, shared, stage, &setting.view, light);
    simple::open_sky(level, shared);
    lighting::arriving(level, shared, light, setting.haze);
    match material {
        Material::Facade(look, face) => {
            points(level, shared, blocks, stage, &setting.view);
            simple::windows(level, shared, blocks, look, face, light, tone);
        }
        Material::Leaves => {
            points(level, shared, blocks, stage, &setting.view);
            swell(level, shared, crowns, setting.view.position, setting.view.pixel());
            even_leaves(level, blocks, crowns, setting.view.position);
            lighting::develop_bent(level, shared, blocks, light, tone);
        }
        Material::Scan => {
            reflect(blocks, albedo);
            blocks.iter_mut().for_each(|block| block.sunlight = [1.0; WIDE]);
            let kinds = Kinds { glows: false, shiny: false, shaded: false };
            lighting::develop(level, shared, blocks, light, tone, kinds);
        }
        Material::Ground(label) => simple::even(level, shared, blocks, simple::ground_colour(*label), tone),
        Material::Even => simple::even_fours(level, shared, blocks, colours, tone),
        Material::Skin(look) => simple::even(level, shared, blocks, look.even, tone),
        // The sky is done; all others are even in this look.
        Material::Sky
        | Material::Roof(_)
        | Material::Tiles(_)
        | Material::Thing(_)
        | Material::Cloth
        | Material::Coach(_) => {}
    }
}
