"""What a person sees and touches. Views show models and write to them only when a person acts."""
