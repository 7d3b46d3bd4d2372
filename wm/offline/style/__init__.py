"""What a theme looks like.

    vocabulary/   the words that are known, as tables
    lexicon       the words of a text, and what a single one may mean
    words         read_theme: a text to a ThemeReading
    reading       ThemeReading: what was read, and which words were used
    finish        the vocabulary of materials and slots, and the records that name and colour them
    style_sheet   StyleSheet: the choices that define a family, and the style built from them
    families/     the style families, and the places with looks of their own
    blending      two families in one sheet
    coloring      the palette of a theme in a sheet
    requests      what a theme asks of walls, floors and furniture
    mood          what moods make of light, shapes and wear
    theme         style_of: a theme's words to a style
"""
