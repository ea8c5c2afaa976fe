"""All grammars of paraphrases by their number, for check_text_judge.py."""

from paraphrases import FifthChinese, FifthEnglish, FourthChinese, FourthEnglish, SecondChinese, SecondEnglish, ThirdChinese, ThirdEnglish
from paraphrases_eighth import EighthChinese, EighthEnglish
from paraphrases_eleventh import EleventhChinese, EleventhEnglish
from paraphrases_fourteenth import FourteenthChinese, FourteenthEnglish
from paraphrases_ninth import NinthChinese, NinthEnglish
from paraphrases_seventh import SeventhChinese, SeventhEnglish
from paraphrases_sixth import SixthChinese, SixthEnglish
from paraphrases_tenth import TenthChinese, TenthEnglish
from paraphrases_thirteenth import ThirteenthChinese, ThirteenthEnglish
from paraphrases_twelfth import TwelfthChinese, TwelfthEnglish

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
}
