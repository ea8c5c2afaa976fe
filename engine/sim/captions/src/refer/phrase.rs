//! [`Phrase`]: a few properties of the target that nobody else in a picture has.

use crate::part::PicturePart;
use cosfly_domain::{BodyKind, Colour};

/// Faster than this a body moves, m/s; slower than [`STANDS_MPS`] it stands; nobody says what is between.
const MOVES_MPS: f64 = 0.4;
const STANDS_MPS: f64 = 0.05;
/// A body in a picture, by what a phrase may say of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Person or kind of vehicle.
    pub kind: BodyKind,
    /// Colour of the shirt or jacket of a person or rider; of a vehicle, of its paint.
    pub top: Colour,
    /// Colour of the trousers of a person or rider.
    pub trousers: Colour,
    /// Wears a backpack.
    pub backpack: bool,
    /// Carries a bag at the shoulder.
    pub shoulder_bag: bool,
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Middle of the visible pixels as a share of the picture's width; `None` where no pixel is visible.
    pub at: Option<f64>,
}

/// A property that a phrase names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Property {
    /// Colour of the top, or of the paint.
    Top,
    /// Colour of the trousers.
    Trousers,
    /// A backpack.
    Backpack,
    /// A bag at the shoulder.
    ShoulderBag,
    /// Moving or standing.
    Motion,
    /// Part of the picture.
    Part,
}

impl Property {
    /// All properties; a phrase names the earlier ones rather than the later ones.
    pub const ALL: [Self; 6] = [Self::Top, Self::Trousers, Self::Backpack, Self::ShoulderBag, Self::Motion, Self::Part];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Top => "top",
            Self::Trousers => "trousers",
            Self::Backpack => "backpack",
            Self::ShoulderBag => "shoulder_bag",
            Self::Motion => "motion",
            Self::Part => "part",
        }
    }
}

/// The kind of a body and some of its properties.
#[derive(Clone, Debug, PartialEq)]
pub struct Phrase {
    /// The named properties, in the order of [`Property::ALL`].
    pub properties: Vec<Property>,
    /// A body that has them.
    pub of: Candidate,
}

impl Candidate {
    /// Whether the body moves; `None` where nobody could say.
    pub fn moves(&self) -> Option<bool> {
        match self.speed_mps {
            fast if fast >= MOVES_MPS => Some(true),
            slow if slow <= STANDS_MPS => Some(false),
            _ => None,
        }
    }

    /// Part of the picture; `None` near a border and outside.
    pub fn part(&self) -> Option<PicturePart> {
        PicturePart::at(self.at?)
    }

    /// Whether a phrase may name a property of the body.
    fn has(&self, property: Property) -> bool {
        let is_rider = self.kind.row().is_dressed;
        match property {
            // Cab and box of a lorry differ in colour.
            Property::Top => self.kind != BodyKind::Truck,
            Property::Trousers => is_rider,
            Property::Backpack => is_rider && self.backpack,
            Property::ShoulderBag => self.kind.is_person() && self.shoulder_bag,
            // Runners run: nobody asks for the walking one.
            Property::Motion => self.kind != BodyKind::Runner && self.moves().is_some(),
            Property::Part => self.part().is_some(),
        }
    }
}

impl Phrase {
    /// The shortest phrase, of equal ones the one that names the earliest properties, that fits the target and certainly fits
    /// none of the others; `None` where all properties together do not single the target out.
    pub fn unique(target: &Candidate, others: &[Candidate]) -> Option<Self> {
        let sets = 0u32..1 << Property::ALL.len();
        let named =
            |set: u32| Property::ALL.into_iter().enumerate().filter(move |it| set >> it.0 & 1 == 1).map(|it| it.1);
        let mut sets: Vec<Vec<Property>> = sets.map(|set| named(set).collect()).collect();
        sets.sort_by_key(|set| (set.len(), set.clone()));
        let phrases = sets.into_iter().filter(|set| set.iter().all(|it| target.has(*it)));
        let mut phrases = phrases.map(|properties| Self { properties, of: *target });
        phrases.find(|phrase| others.iter().all(|other| !phrase.may_fit(other)))
    }

    /// Whether the phrase may be true of a body: a property that nobody could deny is taken as had.
    pub fn may_fit(&self, body: &Candidate) -> bool {
        let agrees = |property: &Property| match property {
            Property::Top => body.top == self.of.top,
            Property::Trousers => body.trousers == self.of.trousers,
            Property::Backpack => body.backpack == self.of.backpack,
            Property::ShoulderBag => body.shoulder_bag == self.of.shoulder_bag,
            Property::Motion => body.moves().is_none_or(|moves| Some(moves) == self.of.moves()),
            Property::Part => body.part().is_none_or(|part| Some(part) == self.of.part()),
        };
        // Everybody on the pavement is a person.
        let is_called_so = body.kind == self.of.kind || self.of.kind == BodyKind::Pedestrian && body.kind.is_person();
        is_called_so && self.properties.iter().all(agrees)
    }

    pub(super) fn names(&self, property: Property) -> bool {
        self.properties.contains(&property)
    }
}

#[cfg(test)]
mod tests {
    use super::super::words::text;
    use super::*;
    use cosfly_claims::Language;

    fn person(top: Colour, trousers: Colour, backpack: bool, speed_mps: f64, at: f64) -> Candidate {
        let (kind, shoulder_bag) = (BodyKind::Pedestrian, false);
        Candidate { kind, top, trousers, backpack, shoulder_bag, speed_mps, at: Some(at) }
    }

    fn texts(target: &Candidate, others: &[Candidate]) -> Option<[String; 2]> {
        Phrase::unique(target, others)
            .map(|phrase| [Language::En, Language::Zh].map(|language| text(&phrase, language)))
    }

    #[test]
    fn a_phrase_is_as_short_as_the_others_allow() {
        use Colour::{Black, Blue, Green, Red};
        let target = person(Red, Blue, true, 1.3, 0.1);
        assert_eq!(texts(&target, &[]).unwrap(), ["the person", "那个人"]);
        let green = person(Green, Blue, false, 1.3, 0.1);
        assert_eq!(texts(&target, &[green]).unwrap(), ["the person in a red top", "穿红色上衣的人"]);
        let twin = |backpack, speed_mps, at| person(Red, Blue, backpack, speed_mps, at);
        assert_eq!(
            texts(&target, &[twin(false, 1.3, 0.1), person(Green, Black, true, 0.0, 0.9)]).unwrap(),
            ["the person in a red top with a backpack", "穿红色上衣、背着背包的人"]
        );
        let bag = Candidate { backpack: false, shoulder_bag: true, ..target };
        assert_eq!(
            texts(&bag, &[twin(false, 1.3, 0.1)]).unwrap(),
            ["the person with a shoulder bag", "挎着单肩包的人"]
        );
        assert_eq!(texts(&target, &[twin(true, 0.0, 0.1)]).unwrap(), ["the walking person", "正在行走的人"]);
        assert_eq!(
            texts(&target, &[twin(true, 1.0, 0.9)]).unwrap(),
            ["the person on the left of the picture", "画面左侧的人"]
        );
        let fast = Candidate { speed_mps: 2.5, ..target };
        assert_eq!(texts(&fast, &[twin(true, 0.0, 0.1)]).unwrap(), ["the running person", "正在跑步的人"]);
        // At the border of the picture's parts, and of motion, nobody could deny that the phrase fits.
        assert_eq!(texts(&target, &[twin(true, 0.2, 0.35)]), None);
        assert_eq!(texts(&target, &[Candidate { kind: BodyKind::Bicycle, ..target }]).unwrap()[0], "the person");
        // A child is a person, too; a person is no child.
        let child = Candidate { kind: BodyKind::Child, ..target };
        assert_eq!(texts(&target, &[child]), None);
        assert_eq!(texts(&child, &[target]).unwrap(), ["the child", "那个孩子"]);
        let user = Candidate { kind: BodyKind::Wheelchair, ..target };
        assert_eq!(
            texts(&user, &[Candidate { speed_mps: 0.0, ..user }]).unwrap(),
            ["the moving wheelchair user", "正在行驶的轮椅使用者"]
        );
    }

    #[test]
    fn vehicles_have_paint_and_lorries_none() {
        let car = Candidate { kind: BodyKind::Car, ..person(Colour::White, Colour::White, false, 8.0, 0.9) };
        let red = Candidate { top: Colour::Red, ..car };
        assert_eq!(texts(&red, &[car]).unwrap(), ["the red car", "红色的汽车"]);
        assert_eq!(texts(&car, &[Candidate { speed_mps: 0.0, ..car }]).unwrap(), ["the moving car", "正在行驶的汽车"]);
        let [truck, other] = [car, red].map(|it| Candidate { kind: BodyKind::Truck, ..it });
        assert_eq!(texts(&truck, &[other]), None);
        let rider = Candidate { kind: BodyKind::Bicycle, ..red };
        assert_eq!(
            texts(&rider, &[Candidate { top: Colour::Blue, ..rider }]).unwrap(),
            ["the cyclist in a red top", "穿红色上衣的骑车人"]
        );
    }
}
