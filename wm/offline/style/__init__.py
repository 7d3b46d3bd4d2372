"""What a theme looks like.

    finish     the vocabulary of materials and slots, and the records that name and colour them
    sheet      what a family says
    families/  the style families
    theme      style_of: a theme's words to a style
"""
