"""Language backends of real models: floor plans, and the names of what stands in a room.

    claude             Anthropic's service, by its SDK
    openai_compatible  any server of OpenAI's chat dialect: the service itself, vLLM, llama.cpp, Ollama
    conversation       Conversation: what a model is told, and the schema of its answer
    speaking_model     SpeakingModel: the backend that both of them make
    spoken_text        an answer without the reasoning before it
    thing_names        the names of things in an answer, cleaned for a segmentation model
"""
