"""Segmentation by SAM 3 (facebook/sam3, transformers): found by names, or at a person's clicks.

    sam3_text    what a language model, the user or a list names, found by Sam3Model
    sam3_clicks  what a person has clicked at, segmented by Sam3TrackerModel
    sam3         the checkpoint, its two models, and images as they take them
    detector     detect: instances by name, the model behind sam3_text
    tracker      Tracker: instances by clicks, the model behind sam3_clicks
    masks        masks at the size of the image, duplicates removed, and as bytes
"""
