"""What words of five languages say of up and down: a table that knows nothing of the templates.

A reader without the labels of the parts takes each verb by itself. So a verb has one meaning, which
is a quantity: where the axis moves now, which way it accelerates, what its highest and its lowest
point are compared with no push, and what the mean height is. A phrase of the table gives the
quantity, by the name of its group, and the way, by the word.
"""

import re
from collections.abc import Iterator

NUMBER = r"[\d.,e+-]+(?: rad|°)"
# The way by a word: 1 is up, or higher than without the push.
WAYS = {
    "en": "up 1 down -1 upwards 1 downwards -1 higher 1 lower -1 unchanged 0 rises 1 falls -1",
    "de": "oben 1 unten -1 höher 1 tiefer -1 unverändert 0 steigt 1 sinkt -1",
    "fr": "haut 1 bas -1 augmente 1 diminue -1 inchangé 0",
    "es": "arriba 1 abajo -1 cambio 0 aumenta 1 disminuye -1",
    "tr": "yukarı 1 aşağı -1 yüksek 1 alçak -1 değişmedi 0 artar 1 azalır -1",
}
# How far it goes to a point: further or less far.
FURTHER = {
    "en": "higher 1 less_high -1 lower 1 less_far -1",
    "de": "höher 1 weniger_hoch -1 tiefer 1 weniger_tief -1",
    "fr": "plus_haut 1 moins_haut -1 plus_bas 1 moins_bas -1",
    "es": "más 1 menos -1",
    "tr": "daha_yükseğe_çıkar 1 daha_az_yükselir -1 daha_aşağı_iner 1 daha_az_alçalır -1",
}
PHRASES = {
    "en": (
        r"[Tt]he axis moves (?P<axis>up|down)",
        r"The (?:top|axis) moves (?P<axis>up|down) at first",
        r"the centre of mass moves (?P<mass>up|down)",
        r"the axle accelerates (?P<axle_pull>up|down)wards",
        r"the weight accelerates (?P<weight_pull>up|down)wards",
        rf"rises {NUMBER} (?P<to_highest>higher|less high)",
        rf"falls {NUMBER} (?P<to_lowest>lower|less far)",
        r"no longer (?P<no_highest>rises)(?: or (?P<no_lowest>falls))?",
        r"no longer (?P<no_lowest>falls)",
        rf"highest point(?: of the axis)? is (?:{NUMBER} )?(?P<highest>higher|lower|unchanged)",
        rf"lowest point is (?:{NUMBER} )?(?P<lowest>higher|lower|unchanged)",
        r"mean height(?: of the axis)? (?:is )?(?P<mean>rises|falls|unchanged)",
        r"that of the centre of mass (?P<mean_mass>rises|falls)",
        r"while the weight falls, and smaller while it rises",
        r"a circle that moves along",
        r"same highest and lowest points",
        r"[Pp]ush on the vertical",
    ),
    "de": (
        r"[Dd]ie Achse bewegt sich nach (?P<axis>oben|unten)(?: \(und der Schwerpunkt nach (?P<mass>oben|unten)\))?",
        r"bewegt sich zunächst nach (?P<axis>oben|unten)",
        r"wird die Achse nach (?P<axle_pull>oben|unten) beschleunigt",
        r"wird das Gewicht nach (?P<weight_pull>oben|unten) beschleunigt",
        rf"steigt {NUMBER} (?P<to_highest>höher|weniger hoch)",
        rf"sinkt {NUMBER} (?P<to_lowest>tiefer|weniger tief)",
        r"(?P<no_highest>steigt) und (?P<no_lowest>sinkt) nicht mehr",
        r"(?P<no_highest>steigt) nicht mehr",
        r"(?P<no_lowest>sinkt) nicht mehr",
        rf"höchster Punkt(?: der Achse)? (?:{NUMBER} )?(?P<highest>höher|tiefer|unverändert)",
        rf"tiefster Punkt (?:{NUMBER} )?(?P<lowest>höher|tiefer|unverändert)",
        r"mittlere Höhe(?: der Achse)? (?P<mean>steigt|sinkt|bleibt gleich)",
        r"die des Schwerpunkts (?P<mean_mass>steigt|sinkt)",
        r"während das Gewicht sinkt, und verkleinert ihn, während es steigt",
        r"Präzession wurde beschleunigt",
        r"dieselben höchsten und tiefsten Punkte",
    ),
    "fr": (
        r"axe se déplace vers le (?P<axis>haut|bas)(?: \(et le centre de masse vers le (?P<mass>haut|bas)\))?",
        r"se déplace d’abord vers le (?P<axis>haut|bas)",
        r"l’axe accélère vers le (?P<axle_pull>haut|bas)",
        r"le poids accélère vers le (?P<weight_pull>haut|bas)",
        rf"monte {NUMBER} (?P<to_highest>plus haut|moins haut)",
        rf"descend {NUMBER} (?P<to_lowest>plus bas|moins bas)",
        r"ne (?P<no_highest>monte) ni ne (?P<no_lowest>descend) plus",
        r"ne (?P<no_highest>monte) plus",
        r"ne (?P<no_lowest>descend) plus",
        rf"point le plus haut(?: de l’axe)? (?:plus )?(?P<highest>haut|bas|inchangé)(?: de {NUMBER})?",
        rf"point le plus bas (?:plus )?(?P<lowest>haut|bas|inchangé)(?: de {NUMBER})?",
        r"hauteur moyenne(?: de l’axe)? (?:est )?(?P<mean>augmente|diminue|inchangé)e?",
        r"celle du centre de masse (?P<mean_mass>augmente|diminue)",
        r"augmente le \[moment cinétique\|L\] pendant que le poids descend, et le diminue pendant qu’il monte",
        r"précession accélérée",
        r"un cercle qui se déplace",
        r"points extrêmes",
    ),
    "es": (
        r"l eje se mueve hacia (?P<axis>arriba|abajo)(?: \(y el centro de masa hacia (?P<mass>arriba|abajo)\))?",
        r"se mueve al principio hacia (?P<axis>arriba|abajo)",
        r"el eje acelera hacia (?P<axle_pull>arriba|abajo)",
        r"el peso acelera hacia (?P<weight_pull>arriba|abajo)",
        rf"sube {NUMBER} (?P<to_highest>más|menos)",
        rf"baja {NUMBER} (?P<to_lowest>más|menos)",
        r"ya no (?P<no_highest>sube) ni (?P<no_lowest>baja)",
        r"ya no (?P<no_highest>sube)",
        r"ya no (?P<no_lowest>baja)",
        rf"punto más alto(?: del eje)? (?:{NUMBER} más |sin )(?P<highest>arriba|abajo|cambio)",
        rf"punto más bajo (?:{NUMBER} más |sin )(?P<lowest>arriba|abajo|cambio)",
        r"altura media(?: del eje)? (?P<mean>aumenta|disminuye|no cambia)",
        r"la del centro de masa (?P<mean_mass>aumenta|disminuye)",
        r"aumenta el \[momento angular\|L\] mientras el peso baja, y lo disminuye mientras sube",
        r"acelerada la precesión",
        r"mismos puntos más alto y más bajo",
    ),
    "tr": (
        r"[Ee]ksen (?P<axis>yukarı|aşağı) doğru gider",
        r"kütle merkezi (?P<mass>yukarı|aşağı) doğru gider",
        r"önce (?P<axis>yukarı|aşağı) doğru gider",
        r"eksen (?P<axle_pull>yukarı|aşağı) doğru hızlanır",
        r"ağırlık (?P<weight_pull>yukarı|aşağı) doğru hızlanır",
        rf"{NUMBER} (?P<to_highest>daha yükseğe çıkar|daha az yükselir)",
        rf"{NUMBER} (?P<to_lowest>daha aşağı iner|daha az alçalır)",
        r"artık ne (?P<no_highest>yükselir) ne (?P<no_lowest>alçalır)",
        r"artık (?P<no_highest>yükselmez)",
        r"artık (?P<no_lowest>alçalmaz)",
        rf"en yüksek nokta(?:sı)? (?:{NUMBER} daha )?(?P<highest>yüksek|alçak|değişmedi)",
        rf"en alçak nokta (?:{NUMBER} daha )?(?P<lowest>yüksek|alçak|değişmedi)",
        r"ortalama yüksekli(?:k|ği) (?P<mean>artar|azalır|değişmedi)",
        r"kütle merkezininki (?P<mean_mass>artar|azalır)",
        r"ağırlık alçalırken \[açısal momentumu\|L\] büyütür, yükselirken küçültür",
        r"tümü artar",  # all of the torque is left
        r"presesyon hızlandırıldı",
        r"en yüksek ve en alçak noktalar",
    ),
}
# Words of up and down, and of rising and falling; outside of a phrase of the table there is none.
STEMS = {
    "en": r"\b(?:ris|rose|fall|fell|mov|accelerat|high|low|up|down|above|climb|sink|drop)\w*",
    "de": r"\b(?:steig|stieg|sink|sank|fäll|fall|beweg|beschleunig|höh|höchst(?!ens)|hoch|tief|oben|unten|aufw|abw)\w*",
    "fr": r"\b(?:mont(?:e|er)|descend|dépla|accél|haut|bas|augment|diminu)\w*",
    "es": r"\b(?:sub|baj|muev|acel|alt|arriba|abajo|aument|disminu)\w*",
    "tr": r"\b(?:yüksel|alçal|yukarı|aşağı|hızlan|yüksek|alçak|art|azal)\w*",
}
# Of the precession, of a rate among others, and of what there is not.
NEUTRAL = {
    "en": r"lies (?:above|below)|comes up to|there is no weight that could rise",
    "de": r"kein Gewicht[^(]*|beschleunigen oder verzögern|seine Höhe",
    "fr": r"(?:pas de|aucun) poids[^(]*|sa hauteur|accélérer ou à ralentir",
    "es": r"no hay peso[^(]*|su altura|acelerar o frenar",
    "tr": r"[^:]*ağırlık yok|yüksekliğini korur|hızlandırılacak ya da yavaşlatılacak",
}


def read_words(text: str) -> dict[str, int]:
    return {
        word.replace("_", " "): int(way)
        for word, way in zip(text.split()[::2], text.split()[1::2], strict=True)
    }


def read_facts(language: str, text: str) -> Iterator[tuple[str, int]]:
    """Yield each quantity that a text speaks of, and its way; fail at a word of no phrase."""
    ways, further = read_words(WAYS[language]), read_words(FURTHER[language])
    left = re.sub(NEUTRAL[language], "", text)
    for phrase in PHRASES[language]:
        for found in re.finditer(phrase, left):
            for name, word in found.groupdict().items():
                if word:
                    yield read_fact(name, word, ways, further)
        left = re.sub(phrase, "#", left)
    word = re.search(STEMS[language], left)
    assert not word, f"{word[0]!r} is of no phrase in {left!r}"


def read_fact(name: str, word: str, ways: dict[str, int], further: dict[str, int]) -> tuple[str, int]:
    point = name.partition("_")[2]
    if name.startswith("no_"):  # a highest point that is no longer reached is lower than it was
        return point, -1 if point == "highest" else 1
    if name.startswith("to_"):
        return point, further[word] * (1 if point == "highest" else -1)
    return name, ways.get(word, 0)


OPPOSITE = (("axis", "mass"), ("mean", "mean_mass"))


def find_contradictions(facts: list[tuple[str, int]]) -> list[str]:
    """Return the quantities that are said to go two ways."""
    said: dict[str, set[int]] = {}
    for name, way in facts:
        said.setdefault(name, set()).add(way)
    found = [name for name, ways in said.items() if len(ways) > 1]
    for one, other in OPPOSITE:
        if one in said and other in said and said[one] != {-way for way in said[other]}:
            found.append(f"{one} and {other}")
    return found
