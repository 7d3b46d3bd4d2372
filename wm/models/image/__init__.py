"""Image backends of real models.

What they are shown, told and read is the same for all. A backend returns what registers with the view's camera pixel by pixel,
whatever size its model draws.

    nano_banana_pro  Google's Gemini image models, by google-genai
    openai_images    OpenAI's GPT image models, by the images edit endpoint
    flux2_klein      FLUX.2 [klein] of Black Forest Labs, on this machine
    drawing          DrawingRequest: what a model is shown and told for a view
    drawing_model    DrawingModel: a backend that asks a service for images
    pictures         images as files: what models are sent, and what they send
    registration     views on the canvases that models offer, without shifting a pixel
"""
