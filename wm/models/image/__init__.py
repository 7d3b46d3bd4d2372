"""Image backends of real models.

Each backend is a service or a local model; what they are shown, told and read is the same for all.

    nano_banana_pro  Google's Gemini image models, by google-genai
    openai_images    OpenAI's GPT image models, by the images edit endpoint
    drawing          DrawingRequest: what a model is shown and told for a view
    drawing_model    DrawingModel: a backend that asks a service for images
    pictures         images as files: what models are sent, and what they send
    registration     views on the canvases that models offer, without shifting a pixel
"""
