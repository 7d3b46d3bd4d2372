"""What a theme looks like.

finish        the vocabulary of materials and slots, and the records that name and colour them
style_sheet   StyleSheet: the choices that define a family, and the style built from them
families/     the style families
theme         style_of: a theme's words to a style
"""
