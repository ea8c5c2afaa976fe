"""All grammars of paraphrases by their number, for check_text_judge.py."""

from paraphrases import FifthChinese, FifthEnglish, FourthChinese, FourthEnglish, SecondChinese, SecondEnglish, ThirdChinese, ThirdEnglish
from paraphrases_eighth import EighthChinese, EighthEnglish
from paraphrases_eighteenth import EighteenthChinese, EighteenthEnglish
from paraphrases_eleventh import EleventhChinese, EleventhEnglish
from paraphrases_fifteenth import FifteenthChinese, FifteenthEnglish
from paraphrases_fourteenth import FourteenthChinese, FourteenthEnglish
from paraphrases_nineteenth import NineteenthChinese, NineteenthEnglish
from paraphrases_ninth import NinthChinese, NinthEnglish
from paraphrases_seventeenth import SeventeenthChinese, SeventeenthEnglish
from paraphrases_seventh import SeventhChinese, SeventhEnglish
from paraphrases_sixteenth import SixteenthChinese, SixteenthEnglish
from paraphrases_sixth import SixthChinese, SixthEnglish
from paraphrases_tenth import TenthChinese, TenthEnglish
from paraphrases_thirteenth import ThirteenthChinese, ThirteenthEnglish
from paraphrases_twelfth import TwelfthChinese, TwelfthEnglish
from paraphrases_twentieth import TwentiethChinese, TwentiethEnglish
from paraphrases_twentyfirst import TwentyFirstChinese, TwentyFirstEnglish
from paraphrases_twentyfourth import TwentyFourthChinese, TwentyFourthEnglish
from paraphrases_twentysecond import TwentySecondChinese, TwentySecondEnglish

GRAMMARS = {
    2: (SecondEnglish, SecondChinese),
    3: (ThirdEnglish, ThirdChinese),
    4: (FourthEnglish, FourthChinese),
    5: (FifthEnglish, FifthChinese),
    6: (SixthEnglish, SixthChinese),
    7: (SeventhEnglish, SeventhChinese),
    8: (EighthEnglish, EighthChinese),
    9: (NinthEnglish, NinthChinese),
    10: (TenthEnglish, TenthChinese),
    11: (EleventhEnglish, EleventhChinese),
    12: (TwelfthEnglish, TwelfthChinese),
    13: (ThirteenthEnglish, ThirteenthChinese),
    14: (FourteenthEnglish, FourteenthChinese),
    15: (FifteenthEnglish, FifteenthChinese),
    16: (SixteenthEnglish, SixteenthChinese),
    17: (SeventeenthEnglish, SeventeenthChinese),
    18: (EighteenthEnglish, EighteenthChinese),
    19: (NineteenthEnglish, NineteenthChinese),
    20: (TwentiethEnglish, TwentiethChinese),
    21: (TwentyFirstEnglish, TwentyFirstChinese),
    22: (TwentySecondEnglish, TwentySecondChinese),
    24: (TwentyFourthEnglish, TwentyFourthChinese),
}
# Grammars whose instructions may leave out that a person stands: such an instruction is true of a person who walks.
LEAVE_STANDING_OUT = {15, 16, 17, 18, 19, 20, 21, 22, 24}
