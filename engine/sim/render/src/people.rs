//! The people of a frame: who of them can be seen, or throws a shadow that can, and their figures.

use crate::body_bounds::{Bounds, Reach};
use crate::found::BodyPart;
use crate::setup::FrameSetup;
use cosfly_domain::{ObstacleKind, SemanticLabel, TARGET_INSTANCE};
use cosfly_figures::{
    BodyFigure, BodyShape, Clothes, FigureInPicture, FigureTriangle, Fittings, Livery, Region, Wardrobe, add_figure,
};
use cosfly_frames::{DVec3, real};
use cosfly_materials::far_light::FarLight;
use cosfly_materials::vector::Vec3;
use cosfly_raster::eye::Eye;
use cosfly_raster::nearer::Nearer;
use cosfly_raster::visibility::Screen;
use std::ops::Range;

/// Somebody whose figure is built in this frame.
pub(crate) struct Person {
    pub figure: BodyFigure,
    pub clothes: Clothes,
    /// Of a vehicle.
    pub fittings: Fittings,
    /// Linear RGB, indexed by [`Region`].
    pub colours: [[f32; 3]; Region::COUNT],
    /// To the right of the body, unit length.
    pub side_in_world: Vec3,
    pub instance: u32,
    /// Label of all parts of a thing of the town; others have those of their bodies.
    pub town_label: Option<SemanticLabel>,
    /// Triangles of the figure among those of all, where they are needed.
    pub triangles: Range<usize>,
    /// Whether the body itself may be seen.
    pub is_seen: bool,
    /// Part of the screen where the body, its shadow and the light of its lamps may be seen.
    pub reach: Reach,
    /// Height of the body, pixels.
    pub height_px: f64,
}

/// Look of a part of somebody's figure.
#[derive(Clone, Copy)]
pub(crate) struct PartLook {
    /// Index among the members.
    pub person: u32,
    pub region: Region,
    /// The ends of its middle line.
    pub middle_in_world: [DVec3; 2],
}

/// Everybody in a frame; the target comes first, if there is one.
#[derive(Default)]
pub(crate) struct People {
    pub members: Vec<Person>,
    pub triangles: Vec<FigureTriangle>,
    /// Parts of figures that were drawn.
    pub looks: Vec<PartLook>,
    wardrobe: Wardrobe,
    /// Numbers among the members of the target and everybody else, where they were found.
    found: Vec<Option<u32>>,
}

/// Use of the triangles of a figure.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Built {
    ForPicture,
    /// Of vehicles alone, as light falls on their triangles; shadows of people are drawn from the parts of figures.
    OfVehicles,
    Never,
}

impl People {
    /// Takes over a frame's target: always, wherever it is.
    pub fn begin(&mut self, setup: &FrameSetup<'_>, eye: &Eye, screen: &Screen, far: FarLight) {
        self.members.clear();
        self.triangles.clear();
        self.looks.clear();
        if let Some(target) = setup.target.filter(BodyFigure::has_body) {
            let body = Bounds::new(&target);
            let height_px = body.height_px(&target, eye, screen);
            self.add(target, TARGET_INSTANCE, true, body.reach(eye, screen, far), height_px, Built::ForPicture);
        }
    }

    /// Adds those who may matter to the picture; `drawn` is what may hide them.
    pub fn gather(
        &mut self,
        bodies: &[FigureInPicture],
        (eye, screen): (&Eye, &Screen),
        far: FarLight,
        drawn: &Nearer,
    ) {
        for other in bodies.iter().filter(|other| other.figure.has_body()) {
            let body = Bounds::new(&other.figure);
            let may_matter = body.may_matter(&other.figure, eye, screen, far);
            if !may_matter || body.with_shadow(far).is_hidden(eye, screen, drawn) {
                continue;
            }
            let height_px = body.height_px(&other.figure, eye, screen);
            let is_seen = body.is_in_view(eye, screen) && !body.is_hidden(eye, screen, drawn);
            self.add(other.figure, other.instance, is_seen, body.reach(eye, screen, far), height_px, Built::ForPicture);
        }
    }

    /// Adds the cars of the town that may matter to the picture.
    pub fn gather_parked(&mut self, cars: &[FigureInPicture], seen_by: (&Eye, &Screen), far: FarLight, drawn: &Nearer) {
        let first = self.members.len();
        self.gather(cars, seen_by, far, drawn);
        self.members[first..].iter_mut().for_each(|car| car.town_label = Some(ObstacleKind::Car.label()));
    }

    /// Takes over those whose parts were found in a picture; with `drawn`, all who may darken what it shows, too.
    pub fn adopt(
        &mut self,
        setup: &FrameSetup<'_>,
        (eye, screen): (&Eye, &Screen),
        far: FarLight,
        parts: &[BodyPart],
        drawn: Option<&Nearer>,
    ) {
        self.members.clear();
        self.triangles.clear();
        self.looks.clear();
        self.found.clear();
        self.found.resize(setup.others.len() + 1, None);
        for part in parts {
            if let Some(found) = self.found.get_mut(part.who as usize) {
                *found = Some(0);
            }
        }
        let target = setup.target.map(|target| (target, TARGET_INSTANCE));
        let others = setup.others.iter().map(|other| Some((other.figure, other.instance)));
        for (who, body) in core::iter::once(target).chain(others).enumerate() {
            let Some((figure, instance)) = body.filter(|(figure, _)| figure.has_body()) else { continue };
            let (bounds, is_target) = (Bounds::new(&figure), who == 0);
            let darkens = drawn.is_some_and(|drawn| {
                is_target
                    || bounds.may_matter(&figure, eye, screen, far)
                        && !bounds.with_shadow(far).is_hidden(eye, screen, drawn)
            });
            if darkens {
                let height_px = bounds.height_px(&figure, eye, screen);
                let reach = bounds.reach(eye, screen, far);
                self.found[who] = Some(self.members.len() as u32);
                self.add(figure, instance, true, reach, height_px, Built::OfVehicles);
            } else if self.found[who].is_some() {
                self.found[who] = Some(self.members.len() as u32);
                let built = if drawn.is_some() { Built::OfVehicles } else { Built::Never };
                self.add(figure, instance, true, Reach::NOWHERE, 0.0, built);
            }
        }
        let found = &self.found;
        self.looks.extend(parts.iter().map(|part| {
            let person = found.get(part.who as usize).copied().flatten().unwrap_or(0);
            PartLook { person, region: part.region, middle_in_world: part.middle_in_world }
        }));
    }

    fn add(&mut self, figure: BodyFigure, instance: u32, is_seen: bool, reach: Reach, height_px: f64, built: Built) {
        let first = self.triangles.len();
        let clothes = *self.wardrobe.clothes(&figure.clothes_seed);
        let is_person = figure.body.is_person();
        if built == Built::ForPicture || built == Built::OfVehicles && !is_person {
            add_figure(&figure, &clothes, self.members.len() as u32, &mut self.triangles);
        }
        let triangles = first..self.triangles.len();
        let mut colours = match figure.body {
            BodyShape::Person { .. } => [[0.0; 3]; Region::COUNT],
            BodyShape::Vehicle { .. } => Livery::draw(&figure.body, &figure.clothes_seed).colours(&figure.body),
        };
        colours[..clothes.colours.len()].copy_from_slice(&clothes.colours);
        let (sin, cos) = real::sin_cos(figure.state.heading_rad);
        let side_in_world = Vec3::new(-sin as f32, cos as f32, 0.0);
        self.members.push(Person {
            figure,
            clothes,
            fittings: Fittings::of(&figure),
            colours,
            side_in_world,
            instance,
            town_label: None,
            triangles,
            is_seen,
            reach,
            height_px,
        });
    }
}
