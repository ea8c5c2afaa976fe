//! English words by class: things, people, and the words in which people speak of a walk and a camera.

/// Things, times and states that no facts of a flight have, in the singular.
pub const THINGS: &str = "
    building house shop tower church school bridge station wall fence gate roof tree bush hedge garden lawn playpark parkland grass river
    lake pond grove orchard vineyard fountain statue bench lamp lamppost streetlight sign pole hydrant crossing crosswalk junction intersection
    roundabout alley plaza square kerb curb pavement sidewalk gutter driveway avenue boulevard square flyover viaduct
    overpass underpass subway car van truck lorry bus taxi bicycle bike motorcycle motorbike scooter moped tram train
    vehicle minibus coach trailer tractor ambulance helicopter plane aeroplane airplane boat ship ferry yacht traffic
    dog cat bird horse puppy pigeon duck cow sheep squirrel insect rain snow fog mist drizzle storm thunder lightning
    sunshine moonlight sunlight cloud sunset sunrise night dusk dawn midnight noon midday morning afternoon evening
    twilight breakfast lunch lunchtime dinner supper teatime winter summer spring autumn weather breeze gale headwind tailwind frost ice hail puddle mud raining snowing rainy snowy foggy
    windy sunny cloudy stormy misty overcast umbrella hat cap scarf glasses sunglasses phone telephone mobile suitcase
    pram stroller pushchair buggy helmet handbag purse skateboard tunnel stair staircase steps escalator lift elevator
    bakery cafe café restaurant pub bar market supermarket hospital museum hotel cinema theatre theater office factory
    library pharmacy chemist kiosk newsstand stall store mall railway railroad motorway highway canal beach hill
    mountain forest wood meadow field flower flowerbed harbour harbor port pier dock quay playground stadium pool bank
    temple mosque cathedral castle monument memorial cemetery petrol gas garage parasol cane crutch trolley basket
    newspaper magazine book cigarette mask skirt dress shoe boot trainer sneaker sandal glove belt tie sock earphone
    headphone earbud briefcase balloon ladder crane scaffold scaffolding barrier bollard bin dustbin litter billboard poster
    banner flag awning balcony window door doorway porch entrance archway arch column pillar terrace courtyard yard
    apartment skyscraper cottage cabin tent barn warehouse shed hut chimney antenna cable wire traffic-light
    grocery shopping parcel package bottle coffee icecream sandwich food drink guitar camera-bag ball kite toy
    tall old young elderly bald bearded blond blonde pregnant barefoot smoking eating drinking talking chatting singing
    dancing limping cycling jogging crowd group queue audience party family police suburb village
    city town downtown countryside desert island valley cliff rock stone brick concrete sculpture mural graffiti
    skip band orchestra choir flock herd swarm troop squad crew gang throng mob parade procession flipflop machine
    hand-in-hand zebra driveways carpark parking rickshaw wheelchair walker-frame";

/// People whom no facts of a flight have, and words that say more of the target than the facts do.
pub const PERSONS: &str = "
    he she his her him herself himself hers cyclist driver child children kid boy girl man men woman women lady gentleman
    gentlemen friend companion toddler baby infant teenager teen adolescent biker rider motorist colleague neighbour neighbor
    stranger tourist student pupil teacher policeman policewoman police officer guard soldier nurse doctor waiter waitress
    vendor seller shopkeeper worker builder postman courier runner jogger schoolgirl schoolboy grandmother grandfather
    granny grandma grandpa pensioner mother father mum mom dad parent wife husband spouse partner girlfriend boyfriend
    sister brother daughter son uncle aunt cousin passenger commuter hiker skater beggar busker monk priest athlete
    bride groom colonel general captain sergeant sailor fisherman fisherwoman farmer shepherd carpenter plumber electrician
    painter sculptor musician violinist pianist guitarist drummer singer dancer ballerina actor actress clown juggler acrobat
    magician wizard witch poet novelist author journalist reporter photographer librarian professor lecturer scholar scientist
    chemist physicist engineer mechanic welder miner lumberjack gardener florist baker butcher grocer greengrocer chef cook barber
    hairdresser tailor seamstress cobbler blacksmith goldsmith jeweller jeweler watchmaker locksmith janitor caretaker cleaner
    maid butler gardener doorman bouncer bodyguard detective inspector sheriff constable cop firefighter fireman paramedic surgeon
    dentist vet veterinarian midwife therapist psychologist pharmacist accountant banker lawyer barrister solicitor judge
    magistrate politician mayor senator minister president king queen prince princess duke duchess knight bishop nun vicar rabbi
    imam pastor pilgrim missionary salesman saleswoman salesperson merchant trader cashier clerk secretary receptionist typist
    manager boss executive landlord landlady tenant hitchhiker backpacker camper mountaineer climber swimmer surfer sailor
    rower boxer wrestler gymnast cricketer footballer golfer goalkeeper referee umpire coach skier snowboarder sprinter
    jockey cowboy cowgirl rancher hunter trapper fisher angler beekeeper milkman mailman dustman roofer bricklayer mason
    plasterer glazier decorator architect surveyor astronaut stewardess steward gentlewoman grandparent grandson granddaughter
    grandchild nephew niece fiancé fiancée fiance fiancee widow widower orphan veteran retiree infantryman cadet recruit
    conductor porter bellboy usher chauffeur cabbie trucker bus-driver stranger lover buddy mate pal roommate flatmate classmate
    teammate sibling twins youngster oldster elder granddad grandad nan nanny babysitter retired
    bystander onlooker spectator people passersby guy bloke chap lad lass dude twin guest customer";

/// Words in which people speak of a walk, a person's clothes and a camera, in the singular.
pub const HARMLESS: &str = "
    pedestrian walker person target subject individual figure someone somebody passerby human one self figure wearer mark
    drone aircraft uav quadcopter copter craft camera lens gimbal view frame shot picture image footage video film scene
    pilot operator you them it they their its us we me us viewpoint vantage sight eye focus centre center middle horizon
    horizontal sky ground air earth floor feet foot head shoulder back waist leg arm body chest hand heel toe side left
    right top bottom front rear edge angle tilt pitch slant inclination depression elevation altitude height level degree
    metre meter m second minute hour s time occasion moment while instant spell bit little lot few couple number count
    total sum all half third quarter whole rest remainder part portion piece stretch section segment leg stage phase
    walk stroll route way path road street lane course line track trail trip journey outing tour march trek hike distance
    length pace speed rate tempo stride step gait rhythm clip amble saunter ramble wander progress movement motion move
    spot place position point start end beginning finish outset close conclusion destination origin stop pause halt wait
    break breather standstill interruption stay delay hold turn turning bend curve corner uturn swing change veer detour
    direction heading bearing hand lefthander righthander reversal manoeuvre maneuver aboutturn aboutface rightturn leftturn
    gap interval separation spacing range room space clearance margin buffer standoff remove berth reach proximity
    top shirt jacket coat trousers pants jeans garment clothes clothing outfit attire dress-code wear pair colour color
    shade hue sleeve leggings bottoms backpack rucksack knapsack bag pack luggage strap order sequence series succession
    row turn case task job mission assignment goal aim objective order brief instruction plan duty purpose order
    average mean maximum minimum norm limit value figure measure amount extent scale flight recording clip take sequence
    shooting tracking following coverage pursuit chase surveillance watch observation lock touch contact company
    same other another latter former next first second third fourth fifth last final only most least more less very
    beginning entire entirety meantime meanwhile duration period timespan span clock run runtime
    there here ahead behind above below up down away off near far by around about over along through past
    total overall full level
    question charge mind care sure example instance fact detail way manner fashion style ease haste hurry rush
    result effect key note reminder attention please request footstep footfall sharp arrow beeline ruler string pin
    follower chaser tracker pursuer watcher observer eyes lookout sentinel guardian shadow tail tailer hawk glue string tether leash
    thread lead tabs bead sights crosshair crosshairs reticle limpet quarry heels footstep footsteps trace tracks wake nose chin
    neck hip ankle knee elbow fingers thumb palm wrist spine torso midriff belly skin bone cuff collar hem fabric cloth
    cotton denim wool linen leather silk fleece nylon canvas material weave knit textile stitch thread print pattern stripe
    drop slope incline gradient plumb axis plane vertical rung notch click tick dial marker benchmark level ceiling
    pirouette loop arc zigzag dogleg hook elbow corner fork bender lefty righty left-hander rightie hairpin
    hop jump dash sprint plod trudge tramp promenade constitutional footwork pacer
    rig craft bird airframe eye optic optics footage reel snapshot photograph tape monitor screen display
    buffer cushion bumper halfway midway mile yardstick tape rule measure odometer meter watch stopwatch clock chronometer timer
    story tale script scenario brief recipe checklist bullet nutshell summary recap upshot gist synopsis rundown
    spot mat dime penny sixpence marble statue-still rock-still post
    drift vend crow bird's fly
    sortie briefing log logbook entry memo record report capture airtime kit apparatus device sensor viewfinder recorder hover datum
    baseline stance posture garb getup gear apparel ensemble layer half circuit errand promenade jaunt expedition star show hero interest
    soul character player candidate volunteer mover traveller traveler rambler breath clockwork shooter handler flyer flier airframe
    counterpart participant platform whoever party unit flat opposite protagonist star quarry charge lead leader wearer owner pattern trajectory itinerary standpoint hitch";

/// Adjectives, and other words before a noun, that no ending gives away.
pub const ADJECTIVES: &str = "
    short long brief full whole entire steady tight gentle slow quick fast swift smooth sharp hard soft slight single double
    triple sole lone main same other different similar equal exact precise rough mere bare sheer good better best bad clear
    clean plain simple straight direct even odd far near close nearer closer farther further wide narrow high higher low lower
    deep shallow steep flat level big small large great tiny little minor major new next last first second third fourth fifth
    final initial early late later total overall average mean typical normal usual regular constant fixed firm safe sound free
    easy light bright dark pale deep tidy neat modest fair good decent proper own very quite rather fairly more most less
    least much many several few two three four five six seven eight nine ten some any each every both all half such least
    just only about around roughly approximately nearly almost some exactly precisely left right upper lower rear front back
    inner outer sudden complete absolute solid strict set given said stated required desired left-hand right-hand clockwise
    anticlockwise counterclockwise uninterrupted unbroken nonstop whopping mid comfortable respectful walking standing
    following moving running flying filming tracking looking facing covering well also then lefthand righthand";

/// Words that end a phrase.
pub const FUNCTION_WORDS: &str = "
    and or but nor so yet as at by for from in into of off on onto out over to up upon with within without under while when
    where who whom whose which that than then there this these those it they them you we i is are was were be been being am do
    does did has have had having will would shall should can could may might must not no never ever again once twice thrice
    time both either neither else too also just still if unless until till because since before after during plus minus per
    least most first last all once order total between front turn view shot case longer more less nearer closer farther
    further sooner later another other same one ones it's its your our my each every any some few many much anyone nobody
    nothing everything something anything yourself themselves itself ourselves oneself t s re ll ve d m";

/// Words before a noun. `that` and `this` are left out: they begin clauses as often.
pub const DETERMINERS: [&str; 26] = [
    "a", "an", "the", "another", "their", "its", "your", "our", "my", "several", "some", "two", "three", "four",
    "five", "six", "seven", "eight", "nine", "ten", "both", "each", "every", "no", "whose", "any",
];
/// Words after which a noun needs no determiner to be a thing, a company or a time.
pub const BARE_PLACES: [&str; 49] = [
    "with",
    "in",
    "at",
    "near",
    "past",
    "beside",
    "between",
    "among",
    "amid",
    "amidst",
    "outside",
    "inside",
    "opposite",
    "beyond",
    "alongside",
    "through",
    "under",
    "underneath",
    "beneath",
    "carrying",
    "carries",
    "pushing",
    "pushes",
    "pulling",
    "pulls",
    "holding",
    "holds",
    "eating",
    "drinking",
    "reading",
    "riding",
    "wearing",
    "wears",
    "towing",
    "dragging",
    "passing",
    "passes",
    "against",
    "crossing",
    "crosses",
    "amongst",
    "dodging",
    "avoiding",
    "meeting",
    "during",
    "before",
    "after",
    "as",
    "of",
];
/// Words after which even `the` thing is one that nobody spoke of before.
pub const PLACES: [&str; 36] = [
    "past",
    "near",
    "beside",
    "behind",
    "between",
    "among",
    "amongst",
    "amid",
    "amidst",
    "outside",
    "inside",
    "opposite",
    "beyond",
    "alongside",
    "along",
    "through",
    "under",
    "underneath",
    "beneath",
    "across",
    "around",
    "round",
    "against",
    "passing",
    "passes",
    "carrying",
    "carries",
    "pushing",
    "pulling",
    "holding",
    "holds",
    "crossing",
    "crosses",
    "by",
    "over",
    "mind",
];
