"""The style families: palette, materials, furniture shapes and light of each, and the words of a theme that select it.

    contemporary  scandinavian, minimalist, modern, industrial
    historic      gothic, victorian, baroque, roman
    regional      japanese, moroccan, coastal, rustic
    retro         midcentury, art deco
    imagined      clockwork, cyberpunk, surreal
    afar          space, ice, the sea and what sails it, caves, treetops
    eras          decades and movements that the others leave out
    legends       castles, towers of wizards, houses of sweets and of dolls
    town          where people are healed, taught, fed and entertained
"""

from wm.offline.style.families.afar import CAVE, DESERT, ICE, SHIP, SPACE, SUBMARINE, TREEHOUSE, UNDERWATER
from wm.offline.style.families.contemporary import INDUSTRIAL, MINIMALIST, MODERN, SCANDINAVIAN
from wm.offline.style.families.eras import CHINESE, CIRCUS, EGYPTIAN, EIGHTIES, MEXICAN, NOUVEAU, SEVENTIES
from wm.offline.style.families.historic import BAROQUE, GOTHIC, ROMAN, VICTORIAN
from wm.offline.style.families.imagined import CLOCKWORK, CYBERPUNK, SURREAL
from wm.offline.style.families.legends import CANDY, CASTLE, DOLLHOUSE, WIZARD
from wm.offline.style.families.regional import COASTAL, JAPANESE, MOROCCAN, RUSTIC
from wm.offline.style.families.retro import ART_DECO, MIDCENTURY
from wm.offline.style.families.town import BAKERY, BOOKISH, CLINIC, DINER, GREENHOUSE, PRISON, RAMEN, SAUNA, SCHOOL, TAVERN
from wm.offline.style.style_sheet import StyleSheet

FAMILIES: dict[str, StyleSheet] = {
    "gothic": GOTHIC,
    "victorian": VICTORIAN,
    "baroque": BAROQUE,
    "roman": ROMAN,
    "scandinavian": SCANDINAVIAN,
    "minimalist": MINIMALIST,
    "modern": MODERN,
    "midcentury": MIDCENTURY,
    "art_deco": ART_DECO,
    "coastal": COASTAL,
    "rustic": RUSTIC,
    "industrial": INDUSTRIAL,
    "cyberpunk": CYBERPUNK,
    "japanese": JAPANESE,
    "moroccan": MOROCCAN,
    "clockwork": CLOCKWORK,
    "surreal": SURREAL,
    "space": SPACE,
    "ice": ICE,
    "submarine": SUBMARINE,
    "ship": SHIP,
    "cave": CAVE,
    "treehouse": TREEHOUSE,
    "underwater": UNDERWATER,
    "desert": DESERT,
    "clinic": CLINIC,
    "school": SCHOOL,
    "bakery": BAKERY,
    "ramen": RAMEN,
    "diner": DINER,
    "tavern": TAVERN,
    "sauna": SAUNA,
    "bookish": BOOKISH,
    "prison": PRISON,
    "greenhouse": GREENHOUSE,
    "seventies": SEVENTIES,
    "eighties": EIGHTIES,
    "nouveau": NOUVEAU,
    "egyptian": EGYPTIAN,
    "chinese": CHINESE,
    "mexican": MEXICAN,
    "circus": CIRCUS,
    "castle": CASTLE,
    "wizard": WIZARD,
    "candy": CANDY,
    "dollhouse": DOLLHOUSE,
}
"""Every family of the offline world, and every place with looks of its own; "modern" is the neutral one."""
